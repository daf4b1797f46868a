//! Model files as commands name them: by a path, one that ships by its bare name, or a CAD part, which is imported on
//! the way.

use crate::cad;
use palpate_bake::{Model, ModelError};
use std::borrow::Cow;
use std::path::Path;

/// Every model that ships, as text, by name.
pub const SHIPPED: [(&str, &str); 12] = [
    ("table1", include_str!("../../models/table1.toml")),
    ("table1c", include_str!("../../models/table1c.toml")),
    ("cylinder", include_str!("../../models/cylinder.toml")),
    ("sphere", include_str!("../../models/sphere.toml")),
    ("ellipsoid", include_str!("../../models/ellipsoid.toml")),
    ("capped_box", include_str!("../../models/capped_box.toml")),
    ("thin_plate", include_str!("../../models/thin_plate.toml")),
    ("rounded_cylinder", include_str!("../../models/rounded_cylinder.toml")),
    ("sphere_body", include_str!("../../models/sphere_body.toml")),
    ("ellipsoid_body", include_str!("../../models/ellipsoid_body.toml")),
    ("ellipsoid_poles", include_str!("../../models/ellipsoid_poles.toml")),
    ("teapot", include_str!("../../models/teapot.toml")),
];

/// A model file that has been read.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// What messages call it.
    pub label: String,
    /// Its name without a directory, as it stands in the head of the tables.
    pub name: String,
    /// What stands in it.
    pub text: Cow<'static, str>,
}

impl ModelFile {
    /// Reads a file. Where there is none, and the path is a bare name, the model of this name that ships. A CAD part is
    /// imported within the importer's own tolerance.
    ///
    /// # Errors
    /// If there is neither, or what is wrong with the part.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let label = path.display().to_string();
        if let Some((name, text)) = SHIPPED.iter().find(|(name, _)| path.as_os_str() == *name)
            && !path.is_file()
        {
            return Ok(Self { label, name: format!("{name}.toml"), text: Cow::Borrowed(text) });
        }
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        if cad::is_part(path) {
            return Ok(Self { label, name, text: Cow::Owned(cad::model_of(path)?) });
        }
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Self { label, name, text: Cow::Owned(text) }),
            Err(cause) => Err(ModelError::Read { file: label, cause }.into()),
        }
    }

    /// The model, checked.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn model(&self) -> Result<Model, ModelError> {
        Model::parse(&self.text, &self.label)
    }
}

/// Reads and checks the model that a command names.
///
/// # Errors
/// The first thing wrong with it.
pub fn read(path: &Path) -> anyhow::Result<Model> {
    Ok(ModelFile::read(path)?.model()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_file_ships_under_its_name_and_a_path_never_means_a_shipped_one() -> anyhow::Result<()> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
        let files = std::fs::read_dir(&folder).expect("it is there").flatten().map(|entry| entry.path());
        let mut names: Vec<_> = files.filter_map(|file| Some(file.file_stem()?.to_str()?.to_owned())).collect();
        names.sort_unstable();
        let mut shipped = SHIPPED.map(|(name, _)| name);
        shipped.sort_unstable();
        assert_eq!(names, shipped);
        for name in shipped {
            let (bare, file) = (ModelFile::read(Path::new(name))?, folder.join(name).with_extension("toml"));
            assert_eq!((bare.text, bare.name), (ModelFile::read(&file)?.text, format!("{name}.toml")));
        }
        for absent in ["./teapot", "teapot.toml", "no-such-model"] {
            let error = ModelFile::read(Path::new(absent)).expect_err(absent).to_string();
            assert!(error.starts_with(&format!("{absent}: cannot be read")), "{error}");
        }
        Ok(())
    }
}
