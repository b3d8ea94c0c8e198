//! The keys of `[effects]`, shared out among the effects: each has a struct of its own, defined by the macro `keys!`.

use serde::de::MapAccess;

/// A part of the keys of `[effects]`.
pub trait Keys: Default {
    /// Their names; none of an effect that has a section of its own.
    const NAMES: &'static [&'static str] = &[];

    /// Reads the value of one of them.
    ///
    /// # Errors
    /// Those of the value.
    fn read<'de, A: MapAccess<'de>>(&mut self, _key: &str, _map: &mut A) -> Result<(), A::Error> {
        Ok(())
    }
}

/// Defines the struct `Settings` of an effect: keys of `[effects]` as `"key" => field: type = default`, then fields that
/// are read from elsewhere.
macro_rules! keys {
    (
        $($(#[$doc:meta])* $key:literal => $field:ident: $kind:ty = $default:expr,)*
        $(; $($(#[$other_doc:meta])* $other:ident: $other_kind:ty = $other_default:expr,)*)?
    ) => {
        /// The effect as a scene has it.
        #[derive(Clone, Debug)]
        pub struct Settings {
            $($(#[$doc])* pub $field: $kind,)*
            $($($(#[$other_doc])* pub $other: $other_kind,)*)?
        }

        impl Default for Settings {
            fn default() -> Self {
                Self { $($field: $default,)* $($($other: $other_default,)*)? }
            }
        }

        impl $crate::effects::machinery::keys::Keys for Settings {
            const NAMES: &'static [&'static str] = &[$($key),*];

            fn read<'de, A: serde::de::MapAccess<'de>>(
                &mut self,
                key: &str,
                map: &mut A,
            ) -> Result<(), A::Error> {
                match key {
                    $($key => self.$field = map.next_value()?,)*
                    _ => {}
                }
                Ok(())
            }
        }
    };
}
pub(in crate::effects) use keys;
