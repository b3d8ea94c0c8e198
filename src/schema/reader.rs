//! Reads sections from TOML: one reader for all of them, over the tree that the text was parsed to.
//!
//! It is a deserializer of serde of our own because that of `toml` is compiled for each section four times, 1 MB in all, and tells where an
//! error is by bytes of the text alone: this one names the key.

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::{Value, map};

/// Why a value cannot be read. Boxed: every field of every section hands it on.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadError(Box<Why>);

#[derive(Clone, Debug, PartialEq)]
struct Why {
    /// Names of the sections on the way to the value, the innermost first.
    inside_out: Vec<String>,
    message: String,
}

impl ReadError {
    /// Message of serde.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// Key of the value with its sections, as `load.x.force` or `defect[0].length`; empty for the whole.
    pub fn key(&self) -> String {
        let mut key = String::new();
        for name in self.0.inside_out.iter().rev() {
            if !key.is_empty() && !name.starts_with('[') {
                key.push('.');
            }
            key.push_str(name);
        }
        key
    }

    #[cold]
    #[inline(never)]
    fn inside(mut self, name: &str) -> Self {
        self.0.inside_out.push(name.to_owned());
        self
    }
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let key = self.key();
        if key.is_empty() { f.write_str(self.message()) } else { write!(f, "{key}: {}", self.message()) }
    }
}

impl std::error::Error for ReadError {}

impl ReadError {
    #[cold]
    #[inline(never)]
    fn of(message: std::fmt::Arguments<'_>) -> Self {
        Self(Box::new(Why { inside_out: vec![], message: message.to_string() }))
    }
}

// The words are those of serde; here, they are compiled once and not for each field.
impl Error for ReadError {
    #[inline]
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self::of(format_args!("{message}"))
    }

    #[cold]
    #[inline(never)]
    fn missing_field(field: &'static str) -> Self {
        Self::of(format_args!("missing field `{field}`"))
    }

    #[cold]
    #[inline(never)]
    fn duplicate_field(field: &'static str) -> Self {
        Self::of(format_args!("duplicate field `{field}`"))
    }

    #[cold]
    #[inline(never)]
    fn invalid_type(unexpected: Unexpected<'_>, expected: &dyn serde::de::Expected) -> Self {
        Self::of(format_args!("invalid type: {unexpected}, expected {expected}"))
    }
}

/// Reads a section from its table, or any value.
///
/// # Errors
/// With the key.
pub fn read<T: DeserializeOwned>(value: &Value) -> Result<T, ReadError> {
    T::deserialize(Reader(value))
}

/// Reads a value as a visitor wants it.
///
/// # Errors
/// With the key.
pub fn read_with<'de, V: Visitor<'de>>(visitor: V, value: &Value) -> Result<V::Value, ReadError> {
    Reader(value).deserialize_any(visitor)
}

/// A value to be read. Borrowed: of what is owned, each field of each section would have its own code to drop the rest.
#[derive(Clone, Copy)]
struct Reader<'a>(&'a Value);

impl Reader<'_> {
    /// Kind of the value, for messages.
    fn kind(&self) -> Unexpected<'_> {
        match self.0 {
            Value::String(text) => Unexpected::Str(text),
            Value::Integer(number) => Unexpected::Signed(*number),
            Value::Float(number) => Unexpected::Float(*number),
            Value::Boolean(is) => Unexpected::Bool(*is),
            Value::Datetime(_) => Unexpected::Other("a date"),
            Value::Array(_) => Unexpected::Seq,
            Value::Table(_) => Unexpected::Map,
        }
    }
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.0 {
            Value::String(text) => visitor.visit_str(text),
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(is) => visitor.visit_bool(*is),
            Value::Datetime(_) => Err(ReadError::invalid_type(self.kind(), &visitor)),
            Value::Array(entries) => Entries::visit(entries, visitor),
            Value::Table(table) => Keys::visit(table, visitor),
        }
    }

    /// A table alone: no section is written as a list of its values, and reading that would be compiled for each of them.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match self.0 {
            Value::Table(table) => Keys::visit(table, visitor),
            _ => Err(ReadError::invalid_type(self.kind(), &visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        match self.0 {
            Value::String(name) => visitor.visit_enum(Choice { name, content: None }),
            Value::Table(table) => match table.iter().next().filter(|_| table.len() == 1) {
                Some((name, content)) => visitor.visit_enum(Choice { name, content: Some(Reader(content)) }),
                None => Err(ReadError::invalid_type(self.kind(), &"string or table")),
            },
            _ => Err(ReadError::invalid_type(self.kind(), &"string or table")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

/// Entries of a list.
struct Entries<'a> {
    rest: std::slice::Iter<'a, Value>,
    read: usize,
    /// Is a section being read?
    in_section: bool,
}

impl<'a> Entries<'a> {
    fn visit<'de, V: Visitor<'de>>(entries: &'a [Value], visitor: V) -> Result<V::Value, ReadError> {
        let mut entries = Entries { rest: entries.iter(), read: 0, in_section: false };
        match visitor.visit_seq(&mut entries) {
            Ok(read) => entries.at_its_end().map(|()| read),
            Err(why) => Err(entries.place_of(why)),
        }
    }

    #[inline(never)]
    fn next(&mut self) -> Option<Reader<'a>> {
        let value = self.rest.next();
        self.in_section = value.is_some_and(Value::is_table);
        self.read += usize::from(value.is_some());
        value.map(Reader)
    }

    #[inline(never)]
    fn at_its_end(&self) -> Result<(), ReadError> {
        let wanted = format!("an array of length {}", self.read);
        match self.rest.len() {
            0 => Ok(()),
            left => Err(ReadError::invalid_length(self.read + left, &wanted.as_str())),
        }
    }

    /// Numbers of a list are told by the list's key.
    #[cold]
    #[inline(never)]
    fn place_of(&self, why: ReadError) -> ReadError {
        if self.in_section { why.inside(&format!("[{}]", self.read - 1)) } else { why }
    }
}

impl<'de> SeqAccess<'de> for &mut Entries<'_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        self.next().map(|value| seed.deserialize(value)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

/// Keys of a section.
struct Keys<'a> {
    rest: map::Iter<'a, String, Value>,
    /// That which is being read, until its value is.
    current: Option<(&'a String, &'a Value)>,
}

impl<'a> Keys<'a> {
    fn visit<'de, V: Visitor<'de>>(
        table: &'a map::Map<String, Value>,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let mut keys = Keys { rest: table.iter(), current: None };
        visitor.visit_map(&mut keys).map_err(|why| match keys.current {
            Some((key, _)) => why.inside(key),
            None => why,
        })
    }

    #[inline(never)]
    fn next(&mut self) -> Option<&'a str> {
        self.current = self.rest.next();
        self.current.map(|(key, _)| key.as_str())
    }
}

impl<'de> MapAccess<'de> for &mut Keys<'_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some(key) = self.next() else { return Ok(None) };
        let name: StrDeserializer<'_, ReadError> = key.into_deserializer();
        seed.deserialize(name).map(Some)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, ReadError> {
        let Some((_, value)) = self.current else {
            return Err(ReadError::custom("a value was asked for before its key"));
        };
        let read = seed.deserialize(Reader(value))?;
        self.current = None;
        Ok(read)
    }
}

/// One of several: its name, and what it has.
struct Choice<'a> {
    name: &'a str,
    content: Option<Reader<'a>>,
}

impl<'a, 'de> EnumAccess<'de> for Choice<'a> {
    type Error = ReadError;
    type Variant = Content<'a>;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Content<'a>), ReadError> {
        let name: StrDeserializer<'_, ReadError> = self.name.into_deserializer();
        Ok((seed.deserialize(name)?, Content(self.content)))
    }
}

/// Data of a choice beside its name.
struct Content<'a>(Option<Reader<'a>>);

impl<'a> Content<'a> {
    fn value(self) -> Result<Reader<'a>, ReadError> {
        self.0.ok_or_else(|| ReadError::custom("it needs a table"))
    }
}

impl<'de> VariantAccess<'de> for Content<'_> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        self.0.map_or(Ok(()), |value| Err(ReadError::invalid_type(value.kind(), &"its name alone")))
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, ReadError> {
        seed.deserialize(self.value()?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, ReadError> {
        self.value()?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        self.value()?.deserialize_struct("", &[], visitor)
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;

    #[test]
    fn regression_a_section_is_no_list_of_its_values() {
        #[derive(Debug, PartialEq, Deserialize)]
        struct Section {
            length: f64,
            sides: [f64; 2],
        }
        let read = |text: &str| {
            let mut table: toml::Table = toml::from_str(text).unwrap();
            read::<Section>(&table.remove("section").unwrap())
        };
        let section = read("section = { length = 1.0, sides = [2.0, 3.0] }");
        assert_eq!(section, Ok(Section { length: 1.0, sides: [2.0, 3.0] }));
        let list = read("section = [1.0, [2.0, 3.0]]").unwrap_err();
        assert_eq!(list.message(), "invalid type: sequence, expected struct Section");
    }
}
