//! Trees of records in version 2 (section III.A.2): links and attributes of large groups, and chunks of arrays.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use super::Hdf5File;
use chiaroscuro_volume::LoadError;

const FIELD: &str = "tree of records";

/// Bytes of a node beside its records: signature, version, type and checksum.
const NODE_OVERHEAD: u64 = 10;

/// Place of a record relative to those that are wanted: before, among or after them.
type TreeRange<'a> = dyn Fn(&[u8]) -> Ordering + 'a;

/// Tree of records that are sorted.
#[derive(Debug, Clone)]
pub(crate) struct RecordTree {
    /// Type of its records.
    pub(crate) kind: u8,
    node_bytes: u64,
    pub(crate) record_bytes: usize,
    depth: u16,
    root: Option<u64>,
    root_records: u64,
}

/// Node whose records are to be read.
struct TreeNode {
    address: u64,
    records: u64,
    depth: u16,
}

impl RecordTree {
    /// Reads the header of a tree.
    pub(crate) fn open(file: &Hdf5File<'_>, address: u64) -> Result<Self, LoadError> {
        let count = 22 + file.widths().address + file.widths().length;
        let bytes = file.read_block(address, count as u64, FIELD)?;
        let tree = file.parse(&bytes, FIELD, |cursor| {
            cursor.require_signature(*b"BTHD")?;
            cursor.byte()?;
            let kind = cursor.byte()?;
            let (node_bytes, record_bytes, depth) = (cursor.number(4)?, cursor.number(2)?, cursor.number(2)?);
            cursor.take(2)?;
            let (root, root_records) = (cursor.address()?, cursor.number(2)?);
            let (record_bytes, depth) = (record_bytes as usize, depth as u16);
            Ok(Self { kind, node_bytes, record_bytes, depth, root, root_records })
        })?;
        if tree.record_bytes == 0
            || tree.depth > 32
            || tree.node_bytes < NODE_OVERHEAD + tree.record_bytes as u64
        {
            let Self { node_bytes, record_bytes, depth, .. } = tree;
            let why =
                format!("a tree of depth {depth}, nodes of {node_bytes} bytes and records of {record_bytes}");
            return Err(file.broken(FIELD, why));
        }
        Ok(tree)
    }

    /// Returns the wanted records in their order, at most `limit`.
    pub(crate) fn records(
        &self,
        file: &Hdf5File<'_>,
        limit: usize,
        place: &TreeRange<'_>,
    ) -> Result<Vec<Vec<u8>>, LoadError> {
        let mut found = Vec::new();
        let Some(root) = self.root else { return Ok(found) };
        let widths = self.child_widths(file.widths().address);
        let mut visited = BTreeSet::new();
        let mut waiting = vec![TreeNode { address: root, records: self.root_records, depth: self.depth }];
        while let Some(node) = waiting.pop() {
            if !visited.insert(node.address) {
                return Err(file.broken(FIELD, "a tree refers to itself"));
            }
            let TreeNode { address, records, depth } = node;
            let [count_width, total_width] = widths.get(usize::from(depth)).copied().unwrap_or_default();
            let child_bytes = file.widths().address + count_width + total_width;
            let children = if depth == 0 { 0 } else { (records + 1).saturating_mul(child_bytes as u64) };
            let length = records.saturating_mul(self.record_bytes as u64).saturating_add(6 + children);
            let bytes = file.read_block(address, length, FIELD)?;
            let (records, below) = file.parse(&bytes, FIELD, |cursor| {
                cursor.require_signature(if depth == 0 { *b"BTLF" } else { *b"BTIN" })?;
                cursor.take(2)?;
                let held = cursor.take(records as usize * self.record_bytes)?;
                let mut below = Vec::new();
                for _ in 0..if depth == 0 { 0 } else { records + 1 } {
                    let (address, records) = (cursor.present_address()?, cursor.number(count_width)?);
                    cursor.take(total_width)?;
                    below.push(TreeNode { address, records, depth: depth - 1 });
                }
                Ok((held.chunks_exact(self.record_bytes), below))
            })?;
            let places: Vec<Ordering> = records.clone().map(place).collect();
            for (record, _) in records.zip(&places).filter(|(_, place)| place.is_eq()) {
                if found.len() == limit {
                    return Ok(found);
                }
                found.push(record.to_vec());
            }
            // Those between two records that are both before, or both after what is wanted, are left out.
            for (at, child) in below.into_iter().enumerate().rev() {
                let is_after = at.checked_sub(1).is_some_and(|before| places[before].is_gt());
                if !is_after && places.get(at).is_none_or(|place| !place.is_lt()) {
                    waiting.push(child);
                }
            }
        }
        Ok(found)
    }

    /// Widths of the numbers of records in a child, and in all nodes below it, for nodes of each depth.
    fn child_widths(&self, address_width: usize) -> Vec<[usize; 2]> {
        let width = |most: u64| (most.max(1).ilog2() / 8 + 1) as usize;
        let record_bytes = self.record_bytes as u64;
        let most_in_leaf = (self.node_bytes - NODE_OVERHEAD) / record_bytes;
        let count_width = width(most_in_leaf);
        let mut most_below = most_in_leaf;
        let mut widths = vec![[0, 0]];
        for depth in 1..=self.depth {
            let total_width = if depth == 1 { 0 } else { width(most_below) };
            widths.push([count_width, total_width]);
            let child = (address_width + count_width + total_width) as u64;
            let most = self.node_bytes.saturating_sub(NODE_OVERHEAD + child) / (record_bytes + child);
            most_below = (most + 1).saturating_mul(most_below).saturating_add(most);
        }
        widths
    }
}
