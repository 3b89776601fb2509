//! Size limits for looks from untrusted sources: excess is cut while JSON is read, before anything is built from it.
//!
//! Texts and trees go through the same reader, so that nothing larger than a look is ever held in memory.

use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::preset_error::PresetError;
use crate::{MAX_LIGHTS, MAX_NAME_CHARS, MAX_POINTS, MAX_SAVED_BYTES, MAX_SAVED_ENTRIES, MAX_SHAPE_CUTS};
use chiaroscuro_files::{MAX_LOOK_BYTES, sanitised};

// A transfer function of MAX_POINTS points takes nearly a mebibyte with one item per line, and the saved views and
// looks come in addition.
const _: () = assert!(MAX_LOOK_BYTES == (1 << 20) + MAX_SAVED_BYTES);

/// Largest nesting depth of lists and objects: settings have 8 levels.
const MAX_NESTING: usize = 64;

/// Largest number of values in a look: two transfer functions have 2 × 4096 points of 8, a label table 4096 of 8, cuts
/// 32 × 256 points of 3, and the rest a few hundred; saved views and looks have no more than one value per eight bytes.
const MAX_VALUES: usize = 165_000 + MAX_SAVED_BYTES / 8;

/// Largest number of views in the format before they had names: one per digit key.
const MAX_LEGACY_VIEWS: usize = 9;

/// Largest number of characters in a remark (a text whose name begins with an underscore): that of the longest paths.
const MAX_REMARK_CHARS: usize = 4096;

/// Largest number of cuts that are reported one by one.
const MAX_REPORTED_CUTS: usize = 8;

/// JSON tree of a look within its limits, with a report of the cuts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoundedTree {
    /// Tree that is left after the cuts.
    pub(super) tree: Value,
    /// Descriptions of the cuts, a sentence each.
    pub(super) cuts: Vec<String>,
}

/// Parses the JSON of a look and cuts it to its limits.
///
/// # Errors
/// Returns an error if the text is too long, nested too deeply, has too many values, or is not JSON.
pub(super) fn parse_bounded(text: &str) -> Result<BoundedTree, PresetError> {
    if text.len() > MAX_LOOK_BYTES {
        return Err(PresetError::TooLong { bytes: text.len() });
    }
    let mut source = serde_json::Deserializer::from_str(text);
    let bounded = cut_source(&mut source).map_err(PresetError::Syntax)?;
    source.end().map_err(PresetError::Syntax)?;
    Ok(bounded)
}

/// Cuts a tree that has already been parsed.
///
/// # Errors
/// Returns an error if it is nested too deeply or has too many values.
pub(super) fn cut_tree(tree: &Value) -> Result<BoundedTree, PresetError> {
    cut_source(tree).map_err(PresetError::WrongType)
}

fn cut_source<'de, D: Deserializer<'de>>(source: D) -> Result<BoundedTree, D::Error> {
    let log = CutLog::default();
    let place = TreePosition { path: String::new(), depth: 0, max_chars: MAX_NAME_CHARS, log: &log };
    let tree = place.deserialize(source)?;
    Ok(BoundedTree { tree, cuts: log.into_messages() })
}

/// Running count of values, and log of the cuts.
#[derive(Debug, Default)]
struct CutLog {
    values: Cell<usize>,
    cuts: RefCell<Vec<String>>,
    unreported: Cell<usize>,
}

impl CutLog {
    fn add(&self, cut: String) {
        let mut cuts = self.cuts.borrow_mut();
        if cuts.len() < MAX_REPORTED_CUTS {
            cuts.push(cut);
        } else {
            self.unreported.set(self.unreported.get() + 1);
        }
    }

    fn into_messages(self) -> Vec<String> {
        let more = (self.unreported.get() > 0).then(|| format!("{} more cuts", self.unreported.get()));
        self.cuts.into_inner().into_iter().chain(more).collect()
    }
}

/// Position in the tree, which determines the limits of a value.
#[derive(Debug)]
struct TreePosition<'a> {
    path: String,
    depth: usize,
    /// Largest number of characters of texts here.
    max_chars: usize,
    log: &'a CutLog,
}

impl TreePosition<'_> {
    fn child(&self, key: &str) -> Self {
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        let text = if key.starts_with('_') { MAX_REMARK_CHARS } else { self.max_chars };
        Self { path, depth: self.depth + 1, max_chars: text, log: self.log }
    }

    /// Returns the largest number of items of a list or an object here.
    fn max_items(&self) -> usize {
        match self.path.as_str() {
            "lights" => MAX_LIGHTS,
            "cuts.shapes" => MAX_SHAPE_CUTS,
            "views" => MAX_LEGACY_VIEWS,
            "kept" => MAX_SAVED_ENTRIES,
            // Transfer functions, label tables, and settings of later versions.
            _ => MAX_POINTS,
        }
    }

    fn report_excess(&self, found: usize) {
        let (most, path) = (self.max_items(), sanitised(&self.path, MAX_NAME_CHARS));
        if found > most {
            self.log.add(format!("{found} entries of `{path}` were cut to {most}"));
        }
    }

    /// Counts a value.
    ///
    /// # Errors
    /// Returns an error if there are too many values, or the value is nested too deeply.
    fn count_value<E: serde::de::Error>(&self) -> Result<(), E> {
        let values = self.log.values.get() + 1;
        self.log.values.set(values);
        if values > MAX_VALUES {
            return Err(E::custom(format!("more than the {MAX_VALUES} values that a look may have")));
        }
        if self.depth > MAX_NESTING {
            return Err(E::custom(format!(
                "nested deeper than the {MAX_NESTING} levels that a look may have"
            )));
        }
        Ok(())
    }

    fn truncate_text(&self, text: &str) -> String {
        let kept: String = text.chars().take(self.max_chars).collect();
        if kept.len() < text.len() {
            let (found, path) = (text.chars().count(), sanitised(&self.path, MAX_NAME_CHARS));
            self.log.add(format!("a text of {found} characters was cut to {} (`{path}`)", self.max_chars));
        }
        kept
    }
}

impl<'de> DeserializeSeed<'de> for TreePosition<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, source: D) -> Result<Value, D::Error> {
        self.count_value()?;
        source.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for TreePosition<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Number::from_f64(value).map_or(Value::Null, Value::Number))
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(Value::String(self.truncate_text(text)))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while items.len() < self.max_items() {
            let Some(item) = list.next_element_seed(self.child(&items.len().to_string()))? else {
                return Ok(Value::Array(items));
            };
            // Reserves items one by one: the length that a list declares may be wrong.
            items.try_reserve(1).map_err(A::Error::custom)?;
            items.push(item);
        }
        let mut found = items.len();
        while list.next_element::<IgnoredAny>()?.is_some() {
            found += 1;
        }
        self.report_excess(found);
        Ok(Value::Array(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Value, A::Error> {
        let (mut fields, mut found) = (Map::new(), 0);
        while let Some(key) = object.next_key::<String>()? {
            found += 1;
            if fields.len() < self.max_items() {
                let below = self.child(&sanitised(&key, MAX_NAME_CHARS));
                let key = below.truncate_text(&key);
                fields.insert(key, object.next_value_seed(below)?);
            } else {
                object.next_value::<IgnoredAny>()?;
            }
        }
        self.report_excess(found);
        Ok(Value::Object(fields))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn cuts(tree: &Value) -> Vec<String> {
        let text = tree.to_string();
        let (of_text, of_tree) = (parse_bounded(&text).unwrap(), cut_tree(tree).unwrap());
        assert_eq!(of_text, of_tree, "texts and trees are cut alike");
        assert!(cut_tree(&of_text.tree).unwrap().cuts.is_empty(), "what was cut is within its bounds");
        of_text.cuts
    }

    #[test]
    fn what_is_in_bounds_stays_as_it_is() {
        let tree = json!({"a": [1, -2, 0.5, null, true, "x\u{202e}"], "_about": "x".repeat(MAX_REMARK_CHARS), "": {}});
        assert_eq!(cuts(&tree), [""; 0]);
        assert_eq!(cut_tree(&tree).unwrap().tree, tree);
    }

    #[test]
    fn lists_and_texts_are_cut_and_each_cut_is_told() {
        let found = cuts(&json!({
            "lights": vec![json!({"name": "n".repeat(MAX_NAME_CHARS + 1)}); 12],
            "transfer": {"points": vec![json!({"value": 1.0}); MAX_POINTS + 1]},
            "views": (0..10).map(|slot| (slot.to_string(), json!({}))).collect::<Map<_, _>>(),
        }));
        assert_eq!(found.len(), MAX_REPORTED_CUTS + 1);
        assert_eq!(found[0], "a text of 201 characters was cut to 200 (`lights.0.name`)");
        assert_eq!(found[MAX_REPORTED_CUTS], "3 more cuts");
        let found = cuts(&json!({"lights": vec![json!({}); 12], "later": {"films": vec![0; 5000]}}));
        assert_eq!(
            found,
            ["12 entries of `lights` were cut to 8", "5000 entries of `later.films` were cut to 4096"]
        );
        let long = "k".repeat(300);
        let object: Map<_, _> = [(long, json!(1))].into_iter().collect();
        assert!(cuts(&Value::Object(object))[0].contains("300 characters"));
    }

    #[test]
    fn what_no_look_has_is_refused_in_words() {
        let refused = |text: &str| parse_bounded(text).unwrap_err().to_string();
        let nested = |levels: usize| format!("{}1{}", "{\"a\":".repeat(levels), "}".repeat(levels));
        assert!(parse_bounded(&nested(MAX_NESTING)).is_ok());
        assert!(refused(&nested(MAX_NESTING + 1)).contains("nested deeper than the 64 levels"));
        assert!(!refused(&nested(200)).is_empty());
        let row = format!("[{}0],", "0,".repeat(59));
        let nothings = format!("[{}0]", row.repeat(4000));
        assert!(refused(&nothings).contains("values"), "{}", refused(&nothings));
        assert!(refused(&" ".repeat(MAX_LOOK_BYTES + 1)).contains("1.25 MiB"));
        assert!(!refused("{} {}").is_empty() && !refused("").is_empty() && !refused("[1e999]").is_empty());
    }
}
