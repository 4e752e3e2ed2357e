//! The report of a run: one page that opens offline, made from the files of the run.
//!
//! The page holds the numbers as arrays in base64 and makes pictures of them in the browser. Its own sources lie in
//! `page/`, other people's code with its licences in `vendor/`, made by `scripts/report/bundle.sh`.

mod array;
mod differences;
mod error;
mod folder;
mod missing;
mod options;
mod read_vtp;

use super::{OutputError, write_whole_bytes};
use differences::{Difference, differences};
pub use error::ReportError;
use folder::Run;
pub use missing::missing_files;
pub use options::{READ, WOUND_WITH};
use serde::Serialize;
use std::path::Path;

const PAGE: &str = include_str!("page/index.html");
const STYLE: &str = include_str!("page/style.css");
const UPLOT_STYLE: &str = include_str!("vendor/uplot.min.css");
const VENDOR: &str = include_str!("vendor/vendor.min.js");
const LICENSES: &str = include_str!("vendor/LICENSES.txt");
/// In the order in which they use each other.
const SCRIPTS: [&str; 9] = [
    include_str!("page/base.js"),
    include_str!("page/colour.js"),
    include_str!("page/charts.js"),
    include_str!("page/map.js"),
    include_str!("page/section.js"),
    include_str!("page/tube.js"),
    include_str!("page/paint.js"),
    include_str!("page/view.js"),
    include_str!("page/main.js"),
];

#[derive(Serialize)]
struct Data {
    /// of this program
    version: &'static str,
    runs: Vec<Run>,
    /// of the scenes of two runs, if both have left theirs
    differences: Option<Vec<Difference>>,
}

/// Makes the page `path` about one run, or about several side by side, from the folders that they left.
///
/// Only `summary.json` must be there; the page leaves out what other files would tell. The page is complete or absent.
///
/// # Errors
/// Where a folder holds no run, a file is not whole, or the page cannot be written.
pub fn write_report(directories: &[&Path], path: &Path) -> Result<(), ReportError> {
    let runs: Result<Vec<Run>, ReportError> =
        directories.iter().map(|folder| Run::read(folder)).collect();
    let data = Data {
        version: env!("CARGO_PKG_VERSION"),
        runs: runs?,
        differences: match directories {
            [one, other] => differences(one, other),
            _ => None,
        },
    };
    let json = serde_json::to_string(&data).map_err(|source| OutputError::Json {
        path: path.to_owned(),
        source,
    })?;
    let title: Vec<&str> = data.runs.iter().map(|run| run.name.as_str()).collect();
    let page = assemble(&title.join(" and "), &json);
    Ok(write_whole_bytes(path, page)?)
}

/// The page with its parts put in. Each place is named once in the page, and what is put in is not looked at again.
fn assemble(title: &str, json: &str) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    // Text of a script ends at the first `</script`, wherever it stands.
    let json = json.replace('<', "\\u003c");
    let scripts = SCRIPTS.concat();
    let parts = [
        ("{{title}}", title.as_str()),
        ("{{uplot}}", UPLOT_STYLE),
        ("{{style}}", STYLE),
        ("{{licenses}}", LICENSES),
        ("{{data}}", &json),
        ("{{vendor}}", VENDOR),
        ("{{scripts}}", &scripts),
    ];
    let mut rest = PAGE;
    let mut page = String::with_capacity(json.len() + VENDOR.len() + (1 << 17));
    for (name, text) in parts {
        if let Some((before, after)) = rest.split_once(name) {
            page.push_str(before);
            page.push_str(text);
            rest = after;
        }
    }
    page.push_str(rest);
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_put_in_and_no_text_ends_the_script_of_the_data() {
        let page = assemble("a <b> & c", "{\"name\":\"</script><b>\"}");
        assert!(!page.contains("{{title}}") && !page.contains("{{scripts}}"));
        assert!(page.contains("<title>a &lt;b> &amp; c"));
        assert!(page.contains("{\"name\":\"\\u003c/script>\\u003cb>\"}"));
        assert!(page.contains("three.js authors") && page.contains("var Vendor="));
    }

    #[test]
    fn the_page_fetches_nothing() {
        let page = assemble("a", "{}")
            .replace(VENDOR, "")
            .replace(LICENSES, "");
        for word in ["http://", "https://", " src=", "<link"] {
            assert!(!page.contains(word), "{word}");
        }
    }
}
