//! Files with anything in them: the entries of the fuzz targets, on mutated good files.

use proptest::prelude::*;

#[path = "../fuzz/entries.rs"]
mod entries;

/// A tetrahedron with legs of 10 mm.
const TETRAHEDRON: &str = include_str!("../fuzz/corpus/stl/tetrahedron.stl");
const FIG8: &str = include_str!("../src/scene/packed/fig8.toml");
const EVERY_KIND: &str = include_str!("../fuzz/corpus/scene/every_kind.toml");

/// The same tetrahedron as a binary file.
fn binary_tetrahedron() -> Vec<u8> {
    let corners = [
        [0.0_f32; 3],
        [10.0, 0.0, 0.0],
        [0.0, 10.0, 0.0],
        [0.0, 0.0, 10.0],
    ];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut bytes = vec![0; 80];
    bytes.extend(4_u32.to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        for corner in face {
            bytes.extend(corners[corner].iter().flat_map(|x: &f32| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// A good file with some bytes replaced, a piece cut out and a piece doubled.
fn spoilt(good: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let n = good.len();
    let edits = prop::collection::vec((0..n, any::<u8>()), 0..6);
    (edits, 0..n, 0..40_usize, 0..n, 0..40_usize).prop_map(
        move |(edits, cut, cut_length, doubled, doubled_length)| {
            let mut bytes = good.clone();
            for (place, byte) in edits {
                bytes[place] = byte;
            }
            let piece = bytes[doubled..n.min(doubled + doubled_length)].to_vec();
            bytes.drain(cut..n.min(cut + cut_length));
            let place = doubled.min(bytes.len());
            bytes.splice(place..place, piece);
            bytes
        },
    )
}

#[test]
fn the_good_files_are_good() {
    let read = |text: &str| {
        coilwind::settings::SceneSettings::from_toml_str(text, "good", std::path::Path::new(""))
    };
    for text in [FIG8, EVERY_KIND] {
        read(text).expect("a good scene");
        entries::scene(text.as_bytes());
    }
    for bytes in [TETRAHEDRON.as_bytes().to_vec(), binary_tetrahedron()] {
        let mut cursor = std::io::Cursor::new(bytes.clone());
        let mesh = coilwind::geometry::stl::read(&mut cursor, 1e-3).expect("a good mesh");
        assert!((mesh.volume() - 1e-6 / 6.0).abs() < 1e-12);
        entries::stl_file(&bytes);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn scenes_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        entries::scene(&bytes);
    }

    #[test]
    fn spoilt_scenes(bytes in spoilt(FIG8.as_bytes().to_vec())) {
        entries::scene(&bytes);
    }

    #[test]
    fn spoilt_scenes_of_every_kind(bytes in spoilt(EVERY_KIND.as_bytes().to_vec())) {
        entries::scene(&bytes);
    }

    #[test]
    fn meshes_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        entries::stl_file(&bytes);
    }

    #[test]
    fn spoilt_text_meshes(bytes in spoilt(TETRAHEDRON.as_bytes().to_vec())) {
        entries::stl_file(&bytes);
    }

    #[test]
    fn spoilt_binary_meshes(bytes in spoilt(binary_tetrahedron())) {
        entries::stl_file(&bytes);
    }
}
