//! Bearings of two rows, or two sets of balls at one place, in a machine: each becomes a bearing of its own, on the same shaft and in the same seat.

use toml::{Table, Value};

use super::bearing::{Catalogue, leave_balls_free};
use crate::catalogue::DoubleRow;
use crate::schema::{AxialSeat, Mounting, SceneError, reader};

/// The text of a machine with both rows of every double-row bearing in place of it; none if it has none, or what is written cannot be read, which its reader says.
///
/// # Errors
/// With the name of the bearing.
pub fn in_rows(text: &str, catalogue: Catalogue) -> Result<Option<String>, SceneError> {
    let Ok(mut table) = toml::from_str::<Table>(text) else { return Ok(None) };
    let Some(bearings) = table.get_mut("bearing").and_then(Value::as_array_mut) else { return Ok(None) };
    let (mut all, mut some) = (vec![], false);
    for bearing in std::mem::take(bearings) {
        match both(&bearing, catalogue)? {
            Some(rows) => {
                some = true;
                all.extend(rows.map(Value::Table));
            }
            None => all.push(bearing),
        }
    }
    *bearings = all;
    Ok(some.then(|| table.to_string()))
}

/// Both rows of a bearing, that with the smaller x first.
fn both(bearing: &Value, catalogue: Catalogue) -> Result<Option<[Table; 2]>, SceneError> {
    let Some(keys) = bearing.as_table() else { return Ok(None) };
    let text = |key: &str| keys.get(key).and_then(Value::as_str);
    let (Some(name), Some(designation)) = (text("name"), text("catalogue")) else { return Ok(None) };
    let Some(found) = (catalogue.rows)(designation) else { return Ok(None) };
    let Some(Ok(mounting)) = keys.get("mounting").map(reader::read::<Mounting>) else { return Ok(None) };
    let refuse = |key: &str, why: String| SceneError::At {
        place: format!("bearing \"{name}\""),
        source: Box::new(SceneError::conflict(key, why)),
    };
    let DoubleRow { scene, distance, axial_play, back_to_back, .. } =
        found.map_err(|why| refuse("bearing.catalogue", why.to_string()))?;
    if mounting.axial == AxialSeat::Free {
        let why = format!(
            "{designation} has two rows, whose outer ring would slide as one; here each would slide by itself: give a single-row bearing that slides"
        );
        return Err(refuse("bearing.mounting.axial = \"free\"", why));
    }
    let mut scene: Table =
        toml::from_str(&scene).map_err(|why| refuse("bearing.catalogue", why.to_string()))?;
    leave_balls_free(&mut scene);
    let row = |number: usize, side: f64, direction: &str| {
        let along = 0.5 * side * distance;
        let mut own = keys.clone();
        own.insert("name".into(), format!("{name}-{number}").into());
        own.remove("catalogue");
        own.insert("scene".into(), scene.clone().into());
        let seat = own.entry("mounting").or_insert_with(|| Table::new().into());
        if let Some(seat) = seat.as_table_mut() {
            seat.insert("position".into(), (mounting.position.0 + along).into());
            seat.insert("direction".into(), direction.into());
            if axial_play > 0.0 && !mounting.preload.is_given() {
                let way = Table::from_iter([("displacement".to_owned(), Value::Float(-0.5 * axial_play))]);
                seat.insert("preload".into(), way.into());
            }
            if mounting.has_bore() {
                let (offset, tilt) = mounting.bore();
                let place = Table::from_iter([
                    ("y".to_owned(), Value::Float(offset.y + tilt.z * along)),
                    ("z".to_owned(), Value::Float(offset.z - tilt.y * along)),
                ]);
                seat.insert("offset".into(), place.into());
            }
        }
        own
    };
    let [first, second] = if back_to_back { ["+x", "-x"] } else { ["-x", "+x"] };
    Ok(Some([row(1, -1.0, first), row(2, 1.0, second)]))
}
