//! Tests of every format, number type and orientation: volumes read back equal the written ones.

use super::*;
use chiaroscuro_files::is_written_by_us;
use chiaroscuro_volume::AnatomicalAxes;

/// Relative tolerance of affines, by the numbers that a format stores: those of NIfTI-1 have 24 bits.
fn tolerance(format: VolumeFormat) -> f64 {
    match format {
        VolumeFormat::Nifti | VolumeFormat::NiftiGzip => f64::from(f32::EPSILON),
        _ => 1e-12,
    }
}

/// Returns true if a format stores orientation and origin.
fn stores_geometry(format: VolumeFormat) -> bool {
    !matches!(format, VolumeFormat::Tiff | VolumeFormat::Npy)
}

/// Returns the part of a volume that a format can store.
fn storable_part(format: VolumeFormat, volume: &ExportVolume<'_>, samples: &Samples) -> Volume {
    let world = match format {
        VolumeFormat::Tiff => DAffine3::from_mat3(DMat3::from_diagonal(volume.spacing_mm().into())),
        VolumeFormat::Npy => DAffine3::IDENTITY,
        VolumeFormat::OmeZarr | VolumeFormat::OmeZarrArchive if !volume.is_axis_aligned() => {
            DAffine3::from_mat3(DMat3::from_diagonal(volume.spacing_mm().into()))
        }
        _ => volume.world_from_index(),
    };
    Volume::new("scan", volume.dims(), world, samples.clone()).unwrap()
}

/// Returns the voxels of a reoriented volume, looked up by their world positions.
fn reoriented_samples(volume: &Volume, outgoing: &ExportVolume<'_>) -> Samples {
    let index_from_turned = volume.world_from_index().inverse() * outgoing.world_from_index();
    let [nx, ny, nz] = outgoing.dims();
    let places: Vec<usize> = (0..nx * ny * nz)
        .map(|at| {
            let index = DVec3::new((at % nx) as f64, (at / nx % ny) as f64, (at / (nx * ny)) as f64);
            let [x, y, z] = index_from_turned.transform_point3(index).to_array().map(|n| n.round() as usize);
            x + DIMS[0] * (y + DIMS[1] * z)
        })
        .collect();
    macro_rules! at_places {
        ($($variant:ident),+) => {
            match volume.samples() {
                $(Samples::$variant(values) => {
                    Samples::$variant(places.iter().map(|&place| values[place]).collect())
                })+
            }
        };
    }
    at_places!(U8, I8, U16, I16, U32, I32, F32, F64)
}

#[test]
fn every_format_keeps_every_type_and_orientation() {
    let mut tried = 0;
    for voxel_type in VoxelType::ALL {
        for (world, is_anatomical) in [
            (DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.5, 0.25, 3.0))), false),
            (oblique_affine(), true),
        ] {
            let volume = volume(samples(voxel_type), world).with_anatomical_axes(is_anatomical);
            let all = AnatomicalAxes::all().filter(|_| is_anatomical).map(Some);
            for headings in std::iter::once(None).chain(all) {
                let outgoing = ExportVolume::new(&volume);
                let outgoing = match headings {
                    Some(headings) => outgoing.reoriented(headings).unwrap(),
                    None => outgoing,
                };
                let samples = reoriented_samples(&volume, &outgoing);
                for format in VolumeFormat::ALL {
                    let wanted = storable_part(format, &outgoing, &samples);
                    for is_compressed in [false, true] {
                        if is_compressed && !format.may_be_compressed() {
                            continue;
                        }
                        // Folders take long to be written through to the disk; their own tests have all types.
                        if format.is_pyramid() && voxel_type != VoxelType::I16 {
                            continue;
                        }
                        let file = export_to_temporary_file(format, &outgoing, is_compressed);
                        let found = read_back(&file);
                        let about = format!("{format:?} {voxel_type:?} {headings:?} {is_compressed}");
                        assert_eq!(difference(&found, &wanted, tolerance(format)), None, "{about}");
                        let is_named =
                            stores_geometry(format) && format != VolumeFormat::Vti && !format.is_pyramid();
                        assert_eq!(found.is_anatomical(), is_anatomical && is_named, "{about}");
                        assert_eq!(found.has_unknown_scale(), format == VolumeFormat::Npy, "{about}");
                        assert_eq!(is_written_by_us(&file.path), format != VolumeFormat::Npy, "{about}");
                        tried += 1;
                    }
                }
            }
        }
    }
    assert_eq!(tried, (1 + 49) * (8 * 9 + 2), "types, orientations and none, formats and compressed ones");
}

#[test]
fn a_wrong_voxel_a_wrong_place_and_a_wrong_type_are_noticed() {
    let right = volume(samples(VoxelType::U16), oblique_affine());
    let Samples::U16(mut values) = right.samples().clone() else { panic!("another type") };
    values[17] ^= 1;
    let wrong = volume(Samples::U16(values), oblique_affine());
    assert!(difference(&wrong, &right, 1e-6).is_some_and(|said| said.starts_with("byte 34")));
    let mut moved = oblique_affine();
    moved.translation.x += 1e-2;
    let moved = volume(samples(VoxelType::U16), moved);
    assert!(difference(&moved, &right, 1e-6).is_some_and(|said| said.starts_with("affine 9")));
    let other = volume(samples(VoxelType::I16), oblique_affine());
    assert!(difference(&other, &right, 1e-6).is_some());
    assert_eq!(difference(&right, &right.clone(), 0.0), None);
    // A wrong reorientation gives another volume.
    let body = right.clone().with_anatomical_axes(true);
    let file = export_to_temporary_file(
        VolumeFormat::Nrrd,
        &ExportVolume::new(&body).reoriented("LPS".parse().unwrap()).unwrap(),
        false,
    );
    assert!(difference(&read_back(&file), &right, 1e-6).is_some());
}

#[test]
fn what_nobody_knows_stays_unknown() {
    let place = |affine| volume(samples(VoxelType::I16), affine).with_unknown_scale();
    let nowhere = place(DAffine3::IDENTITY);
    for format in VolumeFormat::ALL {
        let outgoing = ExportVolume::new(&nowhere);
        let found = read_back(&export_to_temporary_file(format, &outgoing, false));
        assert!(found.has_unknown_scale() && !found.is_anatomical(), "{format:?}");
        assert_eq!(difference(&found, &nowhere, 0.0), None, "{format:?}");
        assert_eq!(format.unsupported_metadata(&outgoing), Vec::<&str>::new(), "{format:?}");
    }
    // Relative lengths are known, and the position of a part in the whole.
    let part = place(DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::new(1.0, 1.0, 2.5)),
        translation: DVec3::new(10.0, 0.0, 5.0),
    });
    let outgoing = ExportVolume::new(&part);
    for format in [VolumeFormat::Nrrd, VolumeFormat::MetaImage] {
        let found = read_back(&export_to_temporary_file(format, &outgoing, false));
        assert!(found.has_unknown_scale() && difference(&found, &part, 1e-12).is_none(), "{format:?}");
    }
    let pages = read_back(&export_to_temporary_file(VolumeFormat::Tiff, &outgoing, false));
    assert!(pages.has_unknown_scale());
    assert_eq!(pages.spacing_mm(), part.spacing_mm());
    assert!(
        VolumeFormat::Nifti
            .unsupported_metadata(&outgoing)
            .contains(&"the fact that the voxel size is unknown")
    );
    // Cells of a body of unknown size have sides all the same.
    let body = place(DAffine3::IDENTITY).with_anatomical_axes(true);
    for format in [VolumeFormat::Nrrd, VolumeFormat::MetaImage] {
        let found = read_back(&export_to_temporary_file(format, &ExportVolume::new(&body), false));
        assert!(found.has_unknown_scale(), "{format:?}");
    }
}

/// Returns hints with every kind of metadata.
fn all_hints() -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::Mr;
    hints.set_unit("mg/ml");
    hints.set_padding(-32768.0);
    hints.set_window(-100.0, 300.5);
    hints.set_acquisition("T1, sagittal");
    hints.is_rescaled = true;
    hints
}

#[test]
fn what_is_known_of_values_is_kept_where_it_has_a_place() {
    let hints = all_hints();
    let known = volume(samples(VoxelType::I16), oblique_affine())
        .with_anatomical_axes(true)
        .with_metadata(hints.clone());
    let known = known.with_padding(-32768.0).unwrap();
    let outgoing = ExportVolume::new(&known);
    for format in VolumeFormat::ALL {
        let found = read_back(&export_to_temporary_file(format, &outgoing, false));
        let lost = format.unsupported_metadata(&outgoing);
        let keeps = |what: &str| !lost.contains(&what);
        assert_eq!(found.metadata().padding.is_some(), keeps("the padding value"), "{format:?}");
        assert_eq!(found.metadata().unit().is_some(), keeps("the unit of the values"), "{format:?}");
        if keeps("the padding value") {
            assert_eq!(found.padding_value(), Some(-32768.0), "{format:?}");
        }
        if keeps("the unit of the values") {
            assert_eq!(found.metadata().unit(), Some("mg/ml"), "{format:?}");
        }
        if !matches!(format, VolumeFormat::Npy | VolumeFormat::Vti) && !format.is_pyramid() {
            assert_eq!(found.metadata().window, Some([-100.0, 300.5]), "{format:?}");
        }
        let has_words = [VolumeFormat::Nrrd, VolumeFormat::MetaImage].contains(&format);
        if has_words {
            assert_eq!(found.metadata().modality, Modality::Mr);
            assert_eq!(found.metadata().acquisition(), Some("T1, sagittal"));
            assert_eq!((found.name(), found.ranges()), ("scan", known.ranges()));
        }
        if matches!(format, VolumeFormat::Nifti | VolumeFormat::NiftiGzip) {
            assert_eq!(found.metadata().modality, Modality::Mr);
            assert_eq!(found.metadata().acquisition(), Some("MR, T1, sagittal"));
        }
    }
    assert_eq!(read_back(&export_to_temporary_file(VolumeFormat::Nrrd, &outgoing, true)).metadata(), &hints);
    // The unit follows from the meaning of the values.
    let mut hints = ValueMetadata::default();
    hints.meaning = ValueMeaning::HounsfieldUnits;
    let ct = volume(samples(VoxelType::I16), oblique_affine()).with_metadata(hints);
    let found = read_back(&export_to_temporary_file(VolumeFormat::MetaImage, &ExportVolume::new(&ct), false));
    assert_eq!(
        (found.metadata().meaning, found.metadata().unit()),
        (ValueMeaning::HounsfieldUnits, Some("HU"))
    );
}

#[test]
fn labels_have_their_names_in_nrrd() {
    let mut hints = ValueMetadata::default();
    hints.meaning = ValueMeaning::Labels;
    hints.modality = Modality::Segmentation;
    hints.labels.insert(2, "Left: kidney = \"good\"", Some([0.25, 0.5, 1.0]));
    hints.labels.insert(-7, "", None);
    let labels = volume(samples(VoxelType::I8), oblique_affine()).with_metadata(hints.clone());
    let outgoing = ExportVolume::new(&labels);
    assert_eq!(read_back(&export_to_temporary_file(VolumeFormat::Nrrd, &outgoing, false)).metadata(), &hints);
    assert!(VolumeFormat::MetaImage.unsupported_metadata(&outgoing).contains(&"names and colours of labels"));
    let found = read_back(&export_to_temporary_file(VolumeFormat::Nifti, &outgoing, false));
    assert_eq!(found.metadata().meaning, ValueMeaning::Labels);
}

#[test]
fn long_axes_and_small_voxels_have_their_forms() {
    // More voxels than 16 bits can count: NIfTI-2.
    let long: Vec<u8> = (0..40_000 * 2).map(|at| (at % 251) as u8).collect();
    let world = DAffine3 { translation: DVec3::new(1.0 / 3.0, 0.1, 1e5), ..oblique_affine() };
    let long =
        Volume::new("scan", [40_000, 2, 1], world, Samples::U8(long)).unwrap().with_anatomical_axes(true);
    for format in [VolumeFormat::Nifti, VolumeFormat::NiftiGzip] {
        let file = export_to_temporary_file(format, &ExportVolume::new(&long), false);
        assert_eq!(difference(&read_back(&file), &long, 1e-15), None, "64-bit numbers");
        assert!(is_written_by_us(&file.path));
    }
    // Spacings in TIFF are written in micrometres.
    let small = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(0.000_65, 0.000_65, 0.002)));
    let small = volume(samples(VoxelType::U16), small);
    let file = export_to_temporary_file(VolumeFormat::Tiff, &ExportVolume::new(&small), false);
    assert_eq!(difference(&read_back(&file), &small, 1e-12), None);
    assert!(std::fs::read(&file.path).unwrap().windows(12).any(|text| text == b"unit=micron\n"));
    // A single slice, and single rows of voxels.
    for dims in [[5, 12, 1], [1, 1, 60], [60, 1, 1]] {
        let flat = Volume::new("scan", dims, DAffine3::IDENTITY, samples(VoxelType::I16)).unwrap();
        let flat = flat.with_unknown_scale();
        for format in VolumeFormat::ALL {
            let found = read_back(&export_to_temporary_file(format, &ExportVolume::new(&flat), false));
            assert_eq!(difference(&found, &flat, 0.0), None, "{format:?} {dims:?}");
        }
    }
}
