//! Header of a Gaussian cube: two title lines, the grid, the atoms, and the list of orbitals.

use glam::{DAffine3, DMat3, DVec3};

use super::super::LoadError;
use super::super::placement::GridPlacement;
use super::super::samples::{ReadFault, is_corruption};
use super::bad_line;
use super::word_reader::CubeWordReader;
use chiaroscuro_volume::LoadContext;

/// Bohr radius in millimetres (CODATA 2018).
const MM_PER_BOHR: f64 = 5.291_772_109_03e-8;

const MM_PER_ANGSTROM: f64 = 1e-7;

/// Maximum number of atoms, which are skipped: that of the largest virus structures.
const MAX_ATOMS: u64 = 10_000_000;

/// Maximum number of orbitals of a file.
const MAX_VALUES: u64 = 4096;

pub(super) struct CubeHeader {
    pub(super) title: String,
    /// Voxels along x, y and z.
    pub(super) dims: [u64; 3],
    pub(super) placement: GridPlacement,
    /// Name of each value of a voxel.
    pub(super) values: Vec<String>,
    atoms: u64,
    has_orbitals: bool,
}

impl CubeHeader {
    pub(super) fn read(context: LoadContext<'_>, words: &mut CubeWordReader<'_>) -> Result<Self, LoadError> {
        let title = line(context, words)?.trim().to_owned();
        line(context, words)?;
        let third = line(context, words)?;
        let numbers: Vec<f64> = third.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let count = third.split_whitespace().next().and_then(|word| word.parse::<i64>().ok());
        let (Some(count), [_, x, y, z, more @ ..]) = (count, &numbers[..]) else {
            return Err(bad_line(context, "line 3", &third, "a number of atoms and an origin"));
        };
        let atoms = count.unsigned_abs();
        if atoms > MAX_ATOMS {
            return Err(context.limit_error(
                "line 3",
                format!("{atoms} atoms exceed the limit of {MAX_ATOMS}"),
                "check that the file is a Gaussian cube",
            ));
        }
        let mut counts = [0i64; 3];
        let mut axes = [DVec3::ZERO; 3];
        for (at, field) in ["line 4", "line 5", "line 6"].into_iter().enumerate() {
            let text = line(context, words)?;
            let mut pieces = text.split_whitespace();
            let n = pieces.next().and_then(|word| word.parse().ok());
            let numbers: Vec<f64> = pieces.map_while(|word| word.parse().ok()).collect();
            let (Some(n), [x, y, z, ..]) = (n, &numbers[..]) else {
                return Err(bad_line(context, field, &text, "a number of voxels and a step"));
            };
            counts[at] = n;
            axes[at] = DVec3::new(*x, *y, *z);
        }
        let has_orbitals = count < 0;
        let values = match more.first() {
            _ if has_orbitals => {
                skip_lines(context, words, atoms)?;
                read_orbitals(context, words)?
            }
            Some(&n) if n > 1.0 && n <= MAX_VALUES as f64 => vec![String::new(); n as usize],
            _ => vec![String::new()],
        };
        // Negative numbers of voxels mean that lengths are in Å.
        let unit = if counts[0] < 0 { MM_PER_ANGSTROM } else { MM_PER_BOHR };
        let [a, b, c] = axes.map(|axis| axis * unit);
        let translation = DVec3::new(*x, *y, *z) * unit;
        let placement =
            GridPlacement::from_ras_affine(DAffine3 { matrix3: DMat3::from_cols(a, b, c), translation })
                .without_anatomy();
        let dims = counts.map(i64::unsigned_abs);
        Ok(Self { title, dims, placement, values, atoms, has_orbitals })
    }

    /// Skips a header that was parsed before.
    pub(super) fn skip(
        &self,
        context: LoadContext<'_>,
        words: &mut CubeWordReader<'_>,
    ) -> Result<(), LoadError> {
        skip_lines(context, words, 6 + self.atoms)?;
        if self.has_orbitals {
            read_orbitals(context, words)?;
        }
        Ok(())
    }
}

/// Reads the list of orbitals: their number, and the identifier of each.
fn read_orbitals(context: LoadContext<'_>, words: &mut CubeWordReader<'_>) -> Result<Vec<String>, LoadError> {
    let mut word = String::new();
    let mut next = || -> Result<String, LoadError> {
        words.word(&mut word).map_err(|fault| error_of(context, fault))?;
        Ok(word.clone())
    };
    let said = next()?;
    let Some(count) = said.parse::<u64>().ok().filter(|count| (1..=MAX_VALUES).contains(count)) else {
        return Err(bad_line(context, "orbitals", &said, "the number of orbitals"));
    };
    (0..count).map(|_| next().map(|id| format!("orbital {id}"))).collect()
}

fn skip_lines(context: LoadContext<'_>, words: &mut CubeWordReader<'_>, count: u64) -> Result<(), LoadError> {
    (0..count).try_for_each(|_| line(context, words).map(drop))
}

fn line(context: LoadContext<'_>, words: &mut CubeWordReader<'_>) -> Result<String, LoadError> {
    let found = words.line().map_err(|fault| error_of(context, fault))?;
    found.ok_or_else(|| {
        context.bad_input_error(
            "header",
            "the file ends within its header",
            "copy or download the file again",
        )
    })
}

fn error_of(context: LoadContext<'_>, fault: ReadFault) -> LoadError {
    match fault {
        ReadFault::Stopped(error) => error,
        ReadFault::Io(error) if !is_corruption(&error) => context.io_error(error),
        ReadFault::NotANumber { text } => bad_line(context, "header", &text, "a short line of numbers"),
        _ => context.bad_input_error(
            "header",
            "the gzip data are broken or truncated",
            "copy or download the file again",
        ),
    }
}
