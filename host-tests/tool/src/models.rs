//! Model files as commands name them: by a path, one that ships by its bare name, a CAD part, which is imported on the
//! way, or a body that is baked already.

use crate::cache::{self, Evidence};
use crate::cad;
use anyhow::{Context as _, bail};
use glam::DVec3;
use palpate_bake::file::BakedFile;
use palpate_bake::locator::LocatorOptions;
use palpate_bake::{BakedBody, Model, ModelError};
use palpate_sim::scene::SceneFile;
use sha2::{Digest as _, Sha256};
use std::borrow::Cow;
use std::io::ErrorKind;
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
    /// Name in messages.
    pub label: String,
    /// File name without the folder, as in the head of the tables.
    pub name: String,
    /// Text of the model; empty if the file holds tables.
    pub text: Cow<'static, str>,
    tables: Option<Box<Tables>>,
}

/// A baked body.
#[derive(Clone, Debug)]
struct Tables {
    bytes: Vec<u8>,
    file: BakedFile,
}

/// Extension of a body's file.
const BAKED: &str = "palp";

impl ModelFile {
    /// Reads a file. A bare name without such a file means the shipped model of this name. A CAD part is imported
    /// within the importer's own tolerance.
    ///
    /// # Errors
    /// If there is neither a file nor a shipped model, or if the part is faulty.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let label = path.display().to_string();
        if let Some((name, text)) = SHIPPED.iter().find(|(name, _)| path.as_os_str() == *name)
            && !path.is_file()
        {
            return Ok(Self { label, name: format!("{name}.toml"), text: Cow::Borrowed(text), tables: None });
        }
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        if cad::is_part(path) {
            return Ok(Self::imported(path, cad::model_of(path)?));
        }
        if is_baked(path) {
            let bytes = std::fs::read(path).map_err(|cause| ModelError::Read { file: label.clone(), cause })?;
            let file = BakedFile::read(&bytes).with_context(|| label.clone())?;
            return Ok(Self { label, name, text: Cow::Borrowed(""), tables: Some(Box::new(Tables { bytes, file })) });
        }
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Self { label, name, text: Cow::Owned(text), tables: None }),
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                let names = SHIPPED.map(|(name, _)| name).join(", ");
                bail!("{label}: cannot be read: there is no such file; name one, or a shipped model: {names}")
            }
            Err(cause) => Err(ModelError::Read { file: label, cause }.into()),
        }
    }

    /// The result of importing a CAD part; messages name the part.
    pub fn imported(part: &Path, text: String) -> Self {
        let name = part.file_name().unwrap_or(part.as_os_str()).to_string_lossy().into_owned();
        Self { label: part.display().to_string(), name, text: Cow::Owned(text), tables: None }
    }

    /// The model, checked.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn model(&self) -> anyhow::Result<Model> {
        match &self.tables {
            None if SceneFile::is_one(&self.text) => {
                bail!("{}: a scene file; name one of its models here, or run it with `sim` or `demo`", self.label)
            }
            None => Ok(Model::parse(&self.text, &self.label)?),
            Some(tables) => Ok(tables.file.model.clone()),
        }
    }

    /// The bytes of the file that are hashed.
    pub fn bytes(&self) -> &[u8] {
        self.tables.as_ref().map_or_else(|| self.text.as_bytes(), |tables| &tables.bytes)
    }

    /// SHA-256 of the model file; for a file of tables, of the model that they were baked from.
    pub fn digest(&self) -> [u8; 32] {
        self.tables.as_ref().map_or_else(|| Sha256::digest(self.text.as_bytes()).into(), |tables| tables.file.source)
    }

    /// The tables, if they are all that the file holds.
    pub fn baked(&self) -> Option<&BakedBody> {
        self.tables.as_ref().map(|tables| &tables.file.body)
    }

    /// The tables of the model: those of the file, or baked with a locator that lists all faces in every cell.
    ///
    /// # Errors
    /// A fault of the model's patches or of the joints between them.
    pub fn body(&self, model: &Model) -> Result<BakedBody, ModelError> {
        self.baked().map_or_else(|| BakedBody::new(model, &self.label), |body| Ok(body.clone()))
    }

    /// The tables with their locator: the file's own, one that was kept, or baked; see [`cache::located`].
    ///
    /// # Errors
    /// Tables that would not fit their indices.
    pub fn located(
        &self,
        body: BakedBody,
        options: &LocatorOptions,
        wanted: Option<&[DVec3]>,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> anyhow::Result<BakedBody> {
        Ok(self.located_with_evidence(body, options, wanted, progress)?.0)
    }

    /// As [`Self::located`], with the evidence for the locator; a file of tables has none.
    ///
    /// # Errors
    /// Tables that would not fit their indices.
    pub fn located_with_evidence(
        &self,
        body: BakedBody,
        options: &LocatorOptions,
        wanted: Option<&[DVec3]>,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> anyhow::Result<(BakedBody, Option<Evidence>)> {
        if self.tables.is_some() {
            return Ok((body, None));
        }
        let (body, evidence) = cache::located(body, &self.text, options, wanted, progress)?;
        Ok((body, Some(evidence)))
    }
}

/// Whether a file holds tables, by its name.
pub fn is_baked(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(BAKED))
}

/// Reads and checks the model that a command names, surfaces in double precision and all.
///
/// # Errors
/// The first thing wrong with it, or that there are only tables.
pub fn read(path: &Path) -> anyhow::Result<Model> {
    anyhow::ensure!(!is_baked(path), "{}: holds tables only; this command needs their model file", path.display());
    ModelFile::read(path)?.model()
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
            assert_eq!((bare.bytes(), &bare.name), (ModelFile::read(&file)?.bytes(), &format!("{name}.toml")));
        }
        for absent in ["./teapot", "teapot.toml", "no-such-model"] {
            let error = ModelFile::read(Path::new(absent)).expect_err(absent).to_string();
            assert!(
                error.starts_with(&format!("{absent}: cannot be read: there is no such file; name one")),
                "{error}"
            );
            assert!(error.contains("capped_box"), "{error}");
        }
        let scene = ModelFile::read(&folder.join("../scenes/effects.toml"))?.model().expect_err("a scene").to_string();
        assert!(
            scene.ends_with("effects.toml: a scene file; name one of its models here, or run it with `sim` or `demo`")
        );
        Ok(())
    }
}
