//! The archive has the layout of FMI, and its bytes depend on nothing but its contents.

use coilwind_model_description::{Contents, PackError, document, model_description, pack};
use std::fs;
use std::io::Read;
use std::path::PathBuf;

fn contents(directory: &std::path::Path) -> Contents {
    let scenes = directory.join("packed");
    fs::create_dir_all(&scenes).expect("directory");
    fs::write(scenes.join("b.toml"), "preset = \"paper\"\n").expect("scene");
    fs::write(scenes.join("a.toml"), "preset = \"default\"\n").expect("scene");
    fs::write(scenes.join("notes.txt"), "not a scene").expect("file");
    let library = directory.join("libCoilWinding.so");
    fs::write(&library, [7_u8; 5000]).expect("library");
    Contents {
        libraries: vec![library],
        scenes: Some(scenes),
        third_party: "what others wrote".to_owned(),
    }
}

#[test]
fn archive_has_the_fmi_layout() {
    let directory = tempfile::tempdir().expect("directory");
    let out = directory.path().join("fmu/CoilWinding.fmu");
    pack(&contents(directory.path()), &out).expect("packed");
    let mut zip = zip::ZipArchive::new(fs::File::open(&out).expect("FMU")).expect("a zip file");
    let names: Vec<_> = (0..zip.len())
        .map(|index| {
            zip.by_index(index)
                .expect("entry")
                .name()
                .map(|n| n.into_owned())
                .expect("name")
        })
        .collect();
    assert_eq!(
        names,
        [
            "modelDescription.xml",
            "binaries/linux64/CoilWinding.so",
            "documentation/coil.png",
            "documentation/index.html",
            "documentation/licenses/license.txt",
            "documentation/licenses/third-party.txt",
            "model.png",
            "resources/scenes/a.toml",
            "resources/scenes/b.toml"
        ]
    );
    let mut read = |name: &str| {
        let mut bytes = Vec::new();
        let mut entry = zip.by_name(name).expect("entry");
        entry.read_to_end(&mut bytes).expect("bytes");
        bytes
    };
    let text = |bytes| String::from_utf8(bytes).expect("text");
    assert_eq!(
        text(read("modelDescription.xml")),
        model_description().expect("description")
    );
    assert_eq!(
        text(read("documentation/index.html")),
        document().expect("page")
    );
    assert_eq!(
        text(read("documentation/licenses/third-party.txt")),
        "what others wrote"
    );
    assert!(text(read("documentation/licenses/license.txt")).contains("MIT"));
    for picture in ["model.png", "documentation/coil.png"] {
        assert!(read(picture).starts_with(b"\x89PNG"), "{picture}");
    }
}

#[test]
fn same_contents_give_the_same_bytes() {
    let directory = tempfile::tempdir().expect("directory");
    let contents = contents(directory.path());
    let (first, second) = (
        directory.path().join("1.fmu"),
        directory.path().join("2.fmu"),
    );
    pack(&contents, &first).expect("packed");
    pack(&contents, &second).expect("packed");
    assert_eq!(
        fs::read(first).expect("first"),
        fs::read(second).expect("second")
    );
}

#[test]
fn missing_scenes_are_left_out_and_odd_libraries_refused() {
    let directory = tempfile::tempdir().expect("directory");
    let out = directory.path().join("out.fmu");
    let mut contents = contents(directory.path());
    contents.scenes = Some(directory.path().join("absent"));
    pack(&contents, &out).expect("packed");
    let library = contents.libraries[0].clone();
    contents.libraries = vec![library.clone(), library];
    assert!(matches!(
        pack(&contents, &out),
        Err(PackError::Twice {
            platform: "linux64",
            ..
        })
    ));
    contents.libraries = vec![PathBuf::from("library.txt")];
    assert!(matches!(
        pack(&contents, &out),
        Err(PackError::Platform { .. })
    ));
    contents.libraries = vec![directory.path().join("absent.so")];
    assert!(matches!(pack(&contents, &out), Err(PackError::File { .. })));
}
