//! The repository: images, boards, budgets and golden points lie in it, and not in an installed tool.

use std::env;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// There is none around.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "firmware images, boards, budgets, the race and CAD parts need palpate's repository, and neither the working \
     directory nor a folder above it is one: run this in a checkout"
)]
pub struct NoRepository;

/// The repository that the working directory is in; else the one of the package that cargo runs, or the one in whose
/// target folder this program lies.
///
/// # Errors
/// If there is none.
pub fn root() -> Result<PathBuf, NoRepository> {
    let starts =
        [env::current_dir().ok(), env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from), env::current_exe().ok()];
    starts.iter().flatten().find_map(|start| around(start)).map(Path::to_path_buf).ok_or(NoRepository)
}

fn around(start: &Path) -> Option<&Path> {
    start.ancestors().find(|folder| {
        ["boards", "src/lib.rs", "host-tests/tool/Cargo.toml"].iter().all(|part| folder.join(part).exists())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_repository_is_found_from_any_folder_in_it_and_from_no_other() {
        let root = root().expect("tests run in it");
        assert_eq!(around(&root.join("host-tests/tool/src")), Some(&*root));
        assert_eq!(around(&std::env::temp_dir()), None);
        assert!(!NoRepository.to_string().contains('\n'), "one sentence");
    }
}
