//! Tests of conversions between number types: exact or rejected, or a range of values mapped to the full range of a
//! type.

use super::*;
use chiaroscuro_volume::ValueRange;

fn wish(voxel_type: VoxelType) -> NumberRequest {
    NumberRequest { voxel_type: Some(voxel_type), rescaled: None, padding: None }
}

fn line(samples: Samples) -> Volume {
    let dims = [samples.len(), 1, 1];
    Volume::new("scan", dims, DAffine3::IDENTITY, samples).unwrap()
}

/// Returns the converted voxels of a volume, and the padding value in its metadata.
fn converted(volume: &Volume, wish: &NumberRequest) -> Result<(Samples, Option<f64>), ConvertError> {
    let outgoing = ExportVolume::new(volume).with_number_type(wish)?;
    let found = read_back(&export_to_temporary_file(VolumeFormat::Nrrd, &outgoing, false));
    assert_eq!(found.samples().voxel_type(), outgoing.voxel_type());
    Ok((found.samples().clone(), found.metadata().padding))
}

#[test]
fn whole_numbers_are_exact_or_refused() {
    for from in VoxelType::ALL {
        for to in VoxelType::ALL {
            // Small numbers fit into every type.
            let few = line(samples(from)).samples().clone();
            let small: Vec<f64> = (0..few.len()).map(|at| (at % 100) as f64).collect();
            let volume = line(Samples::F64(small.clone()));
            let first = ExportVolume::new(&volume).with_number_type(&wish(from)).unwrap();
            let volume = read_back(&export_to_temporary_file(VolumeFormat::Nrrd, &first, false));
            let (found, _) = converted(&volume, &wish(to)).unwrap();
            assert!((0..found.len()).all(|at| found.value(at) == small[at]), "{from:?} {to:?}");
            // The full range of a type fits if each of its numbers does.
            let volume = line(few.clone());
            let is_float = |kind| matches!(kind, VoxelType::F32 | VoxelType::F64);
            if is_float(from) {
                continue;
            }
            let bits = if to == VoxelType::F32 { 24 } else { 53 };
            let fits = match to {
                to if is_float(to) => 8 * from.bytes() <= bits,
                VoxelType::U8 | VoxelType::U16 | VoxelType::U32 => {
                    matches!(from, VoxelType::U8 | VoxelType::U16 | VoxelType::U32)
                        && from.bytes() <= to.bytes()
                }
                _ if matches!(from, VoxelType::U8 | VoxelType::U16 | VoxelType::U32) => {
                    from.bytes() < to.bytes()
                }
                _ => from.bytes() <= to.bytes(),
            };
            match converted(&volume, &wish(to)) {
                Ok((found, _)) => {
                    assert!(fits, "{from:?} {to:?}");
                    assert!((0..few.len()).all(|at| found.value(at) == few.value(at)), "{from:?} {to:?}");
                }
                Err(refused) => {
                    assert!(!fits, "{from:?} {to:?}: {refused}");
                    let said = refused.to_string();
                    assert!(said.contains("--type") && said.contains("choose"), "{said}");
                }
            }
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_with_a_remedy() {
    let refused = |values: Vec<f64>, to| converted(&line(Samples::F64(values)), &wish(to)).unwrap_err();
    let far = refused(vec![-3.0, 300.0], VoxelType::U8);
    assert_eq!(
        far.to_string(),
        "its values range from -3 to 300, uint8 from 0 to 255; choose a wider --type, or --rescale -3:300"
    );
    assert!(matches!(refused(vec![1.0, 2.5], VoxelType::I16), ConvertError::Fractions { value: 2.5, .. }));
    let unknown = refused(vec![1.0, f64::NAN, f64::INFINITY], VoxelType::I16);
    assert!(
        matches!(unknown, ConvertError::NotFinite { count: 2, .. })
            && unknown.to_string().contains("--padding")
    );
    assert!(matches!(refused(vec![0.0, 1e300], VoxelType::F32), ConvertError::OutOfRange { .. }));
    let whole = line(Samples::U32(vec![0, 16_777_217]));
    assert!(matches!(converted(&whole, &wish(VoxelType::F32)), Err(ConvertError::Inexact { .. })));
    let spread = NumberRequest { rescaled: Some(ValueRange::UNIT), ..wish(VoxelType::F32) };
    assert!(matches!(converted(&whole, &spread), Err(ConvertError::RescaledToFloats { .. })));
    for padding in [-1.0, 256.0, 0.5, f64::NAN] {
        let wish = NumberRequest { padding: Some(padding), ..wish(VoxelType::U8) };
        assert!(matches!(converted(&whole, &wish), Err(ConvertError::BadPadding { .. })), "{padding}");
    }
    // Fractions are rounded to the nearest 32-bit float.
    let tenths = line(Samples::F64(vec![0.1, f64::NAN]));
    let (found, _) = converted(&tenths, &wish(VoxelType::F32)).unwrap();
    assert!(found.value(0) == f64::from(0.1f32) && found.value(1).is_nan());
    let no_body = ExportVolume::new(&tenths).reoriented("RAS".parse().unwrap()).unwrap_err();
    assert!(no_body.to_string().contains("does not state the orientation of a body"));
}

#[test]
fn a_range_of_values_becomes_all_numbers_of_a_type() {
    let values = vec![-2000.0, -1000.0, 0.0, 1000.0, 3000.0];
    let onto =
        |voxel_type| NumberRequest { rescaled: Some(ValueRange::new(-1000.0, 1000.0)), ..wish(voxel_type) };
    let (found, padding) = converted(&line(Samples::F64(values.clone())), &onto(VoxelType::U8)).unwrap();
    assert_eq!((found, padding), (Samples::U8(vec![0, 0, 128, 255, 255]), None));
    // The middle lies between −1 and 0.
    let (found, _) = converted(&line(Samples::F64(values.clone())), &onto(VoxelType::I32)).unwrap();
    assert_eq!(found, Samples::I32(vec![i32::MIN, i32::MIN, -1, i32::MAX, i32::MAX]));
    // Only rounding: the range equals that of the type.
    let same = NumberRequest { rescaled: Some(ValueRange::new(-32768.0, 32767.0)), ..wish(VoxelType::I16) };
    let (found, _) = converted(&line(Samples::F32(vec![1.4, -2.6, 1e6])), &same).unwrap();
    assert_eq!(found, Samples::I16(vec![1, -3, 32767]));
    // Missing voxels get a number of their own, which no value is mapped to.
    let gaps = [values, vec![f64::NAN]].concat();
    let (found, padding) = converted(&line(Samples::F64(gaps.clone())), &onto(VoxelType::U8)).unwrap();
    assert_eq!((found, padding), (Samples::U8(vec![1, 1, 128, 255, 255, 0]), Some(0.0)));
    let high = NumberRequest { padding: Some(255.0), ..onto(VoxelType::U8) };
    let (found, padding) = converted(&line(Samples::F64(gaps)), &high).unwrap();
    assert_eq!((found, padding), (Samples::U8(vec![0, 0, 127, 254, 254, 255]), Some(255.0)));
}

#[test]
fn padding_goes_along() {
    let ct = line(Samples::I16(vec![-3024, -1000, 0, 200])).with_padding(-3024.0).unwrap();
    assert_eq!(converted(&ct, &wish(VoxelType::F32)).unwrap().1, Some(-3024.0));
    let other = NumberRequest { voxel_type: None, rescaled: None, padding: Some(-2000.0) };
    let (found, padding) = converted(&ct, &other).unwrap();
    assert_eq!((found, padding), (Samples::I16(vec![-2000, -1000, 0, 200]), Some(-2000.0)));
    assert!(converted(&ct, &wish(VoxelType::U8)).is_err());
    // No voxel has the padding value, and the new type cannot represent it.
    let none = line(Samples::I16(vec![0, 1, 200])).with_padding(-3024.0).unwrap();
    assert_eq!(converted(&none, &wish(VoxelType::U8)).unwrap(), (Samples::U8(vec![0, 1, 200]), None));
    // Rescaled values lose their meaning.
    let mut hints = ValueMetadata::default();
    hints.set_unit("HU");
    hints.modality = Modality::Ct;
    hints.set_window(-1000.0, 1000.0);
    let ct = ct.with_metadata(hints);
    let spread = NumberRequest { rescaled: Some(ValueRange::new(-1000.0, 1000.0)), ..wish(VoxelType::U8) };
    let outgoing = ExportVolume::new(&ct).with_number_type(&spread).unwrap();
    let found = read_back(&export_to_temporary_file(VolumeFormat::Nrrd, &outgoing, false));
    let hints = found.metadata();
    assert_eq!((hints.unit(), hints.meaning, hints.is_rescaled), (None, ValueMeaning::Unknown, true));
    assert_eq!((hints.modality, hints.window, hints.padding), (Modality::Ct, Some([1.0, 255.0]), Some(0.0)));
}
