//! Import and export of Chiaroscuro's own format: a preset that holds only the transfer function.

use serde_json::{Value, json};

use super::{ExchangeError, format_error};
use crate::{Settings, TransferFunction, apply_relative};
use chiaroscuro_volume::{ValueRange, ValueRanges};

/// Returns the place of the transfer function in a preset or a session: at the top level, or in a layer.
pub(crate) fn transfer_path(tree: &Value) -> Option<&'static str> {
    ["/transfer", "/layers/0/transfer"].into_iter().find(|path| tree.pointer(path).is_some())
}

/// Reads the transfer function of a preset or a session.
pub(crate) fn from_preset(tree: &mut Value, range: ValueRange) -> Result<TransferFunction, ExchangeError> {
    let function = transfer_path(tree).and_then(|path| tree.pointer_mut(path)).map(Value::take);
    let overlay = json!({ "transfer": function, "_values": tree["_values"].take() });
    let applied = apply_relative(&Settings::default(), &overlay, &ValueRanges::without_outliers(range));
    let applied = applied.map_err(|err| format_error(&err.to_string()))?;
    Ok(applied.settings.layer().transfer.clone())
}

/// Writes a preset that holds only the transfer function.
pub(crate) fn to_preset(function: &TransferFunction) -> String {
    format!("{:#}\n", json!({ "transfer": function }))
}
