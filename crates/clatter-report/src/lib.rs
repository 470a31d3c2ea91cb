//! Figures, tables and printed reports as pure functions of data.
//!
//! A report computes nothing: it is handed what `clatter` computed and says how it is drawn, worded and set. Figures
//! are SVG, tables JSON and CSV; the page is a typst file that reads them. One module alone starts typst.

mod accuracy;
mod assessment;
mod figure;
mod file;
mod leftovers;
mod page;
mod paper;
mod peers;
mod shock;
mod svg;
mod table;
mod trade;
mod typst;
mod words;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

pub use accuracy::{Measured, measured};
pub use figure::design::{DesignBorder, DesignFronts, DesignPlane};
pub use file::{create, directory_of, replace};
pub use leftovers::remove_leftovers;
pub use shock::shock_numbers;
pub use trade::trade_files;

use page::{page, set};

/// A report that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Report {
    /// The paper's own figures, table and claims.
    Paper,
    /// What the clatter does to a suspended part.
    Shock,
    /// How exact all of it is.
    Accuracy,
}

/// What was written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Written {
    /// The files, the PDF first.
    pub files: Vec<PathBuf>,
    /// What the caller should tell the user.
    pub warnings: Vec<String>,
}

/// Why a report was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// typst is missing, failed or was cut off: an outside program, not a bad input.
    #[error("{0}")]
    Typst(String),
    /// A file could not be written or read.
    #[error("{}: {source}", clatter_assess::visible(&path.display().to_string()))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The report's data could not be computed.
    #[error(transparent)]
    Model(#[from] clatter::Error),
    /// The same of a drop in time.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// The same of a component.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// The same of a product.
    #[error(transparent)]
    Assess(#[from] clatter_assess::Error),
    /// The report's data could not be written as JSON.
    #[error("the report's data: {0}")]
    Data(String),
}

/// Writes a report into `dir`, which is made if it is missing: the PDF, its figures as SVG, its tables as
/// JSON and CSV. `progress` gets one line a step.
///
/// Each file is written beside its place and renamed, so that none is ever half there. The PDF is the same, byte for
/// byte, from run to run, but for the times in that of [`Report::Accuracy`].
///
/// ```no_run
/// // typst may have to be built first
/// let written = clatter_report::write(clatter_report::Report::Paper, "report".as_ref(), &mut |step| eprintln!("{step}"))?;
/// assert!(written.files[0].ends_with("paper.pdf"));
/// # Ok::<(), clatter_report::ReportError>(())
/// ```
///
/// # Errors
/// [`ReportError`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write(report: Report, dir: &Path, progress: &mut dyn FnMut(&str)) -> Result<Written, ReportError> {
    match report {
        Report::Paper => {
            let source = ("paper.typ", include_str!("../../../reports/paper.typ"));
            page(
                "paper.pdf",
                source,
                &|| paper::Data::compute()?.files(),
                &[("page.json", &paper::page())],
                dir,
                progress,
            )
        }
        Report::Shock => {
            let source = ("shock.typ", include_str!("../../../reports/shock.typ"));
            page(
                "shock.pdf",
                source,
                &|| shock::Data::compute()?.files(),
                &[("page.json", &paper::page())],
                dir,
                progress,
            )
        }
        Report::Accuracy => {
            let source = ("accuracy.typ", include_str!("../../../reports/accuracy.typ"));
            let data = paper::page();
            let inputs = [
                ("page.json", data.as_str()),
                ("trade.typ", include_str!("../../../reports/trade.typ")),
                ("peers.typ", include_str!("../../../reports/peers.typ")),
            ];
            page("accuracy.pdf", source, &accuracy_files, &inputs, dir, progress)
        }
    }
}

/// Errors, the trade between them and time, and what other tools make of the same scenes.
fn accuracy_files() -> Result<Vec<paper::File>, ReportError> {
    let mut files = accuracy::Data::compute()?.files()?;
    // After the rest: it takes times.
    files.extend(trade_files()?);
    files.extend(peers()?);
    Ok(files)
}

/// Writes the pages of an assessment to `pdf`: the verdict first, then a part at a time. Gives what the caller should
/// tell the user.
///
/// Where names have characters that the typefaces cannot set, they are drawn as boxes, and a warning says so. The file is
/// written beside its place and renamed; the same assessment gives the same bytes.
///
/// ```no_run
/// // typst may have to be built first
/// use clatter_assess::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let assessment = file.assess()?;
/// let portraits = file.portraits(&assessment)?;
/// clatter_report::write_assessment(&file, &assessment, &portraits, "report.pdf".as_ref(), &mut |_| ())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReportError`]; nothing is left at `pdf` that was not there before.
pub fn write_assessment(
    file: &clatter_assess::ProductFile,
    assessment: &clatter_assess::Assessment,
    portraits: &[clatter_assess::Portrait],
    pdf: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Vec<String>, ReportError> {
    let (typst, mut warnings) = typst::Typst::find(progress)?;
    progress("setting the pages");
    let pages = |assessment| {
        let files = assessment::files(file, assessment, portraits);
        let inputs = files.iter().map(|(name, content)| (name.as_str(), content.as_str()));
        set(&typst, ("assessment.typ", include_str!("../../../reports/assessment.typ")), inputs)
    };
    let bytes = match (pages(assessment), assessment::surely_named(assessment)) {
        (Err(error @ ReportError::Typst(_)), Some(sure)) => {
            progress("setting the pages once more, with plainer names");
            let bytes = pages(&sure).map_err(|_| error)?;
            let told = "the typefaces of the report cannot set some characters of its names: they are drawn as boxes";
            warnings.push(told.to_owned());
            bytes
        }
        (bytes, _) => bytes?,
    };
    replace(pdf, |file| file.write_all(&bytes)).map_err(|source| ReportError::Io { path: pdf.into(), source })?;
    Ok(warnings)
}

/// Which inertia ratios and restitutions make the parts of a product safe.
///
/// ```
/// use clatter::design::{Goal, region};
/// use clatter_report::{DesignBorder, DesignPlane};
/// let border = DesignBorder::Exact(region(&[Goal::zone(0.5, 0.1)?], 1e-3));
/// let plane = DesignPlane { borders: vec![("display".into(), border)], ..DesignPlane::default() };
/// assert!(clatter_report::design_svg(&plane).contains("coefficient of restitution"));
/// # Ok::<(), clatter::Error>(())
/// ```
#[must_use]
pub fn design_svg(plane: &DesignPlane) -> String {
    figure::design::plane(plane)
}

/// The front of the largest safe zone against the inertia ratio, for each restitution.
#[must_use]
pub fn fronts_svg(fronts: &DesignFronts) -> String {
    figure::design::fronts(fronts)
}

/// Error over cost of every model that was measured on the worst drop of each limit, log-log, a panel a limit: the cheapest one
/// within the tolerance is ringed. What is off by less than the reference is known to stands in a strip at the foot.
///
/// ```
/// use clatter_assess::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let ladders = file.ladders(&file.assess()?, 0.01)?;
/// assert!(clatter_report::ladder_svg(&ladders).contains("finite tilt"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn ladder_svg(product: &clatter_assess::ladder::ProductLadder) -> String {
    trade::of_product(product)
}

/// A map as a heat map with a color bar, a cell a grid point; endless (+∞) is shown apart. The color bar is
/// logarithmic where no value is negative and the positive ones span more than a factor of 30.
///
/// ```
/// use clatter::{Axis, Map, Quantity};
/// let map = Map::compute(Quantity::Impacts, Axis::q(0.0, 1.0, 50)?, Axis::e(0.0, 1.0, 50)?)?;
/// assert!(clatter_report::map_svg(&map).contains("endless"));
/// # Ok::<(), clatter::Error>(())
/// ```
#[must_use]
pub fn map_svg(map: &clatter::Map) -> String {
    figure::heat::heat(map)
}

/// What other tools make of the same scenes, each at the best setting found, as `peers/run.py` last measured them:
/// `peers.json` for the page and `peers.svg`, a row a tool with its times, counts and error on the four bars of Table 1.
///
/// The times are those of one machine, which is named beside them.
///
/// ```
/// let files = clatter_report::peers()?;
/// assert!(files.iter().any(|(name, content)| *name == "peers.svg" && content.contains("MuJoCo")));
/// # Ok::<(), clatter_report::ReportError>(())
/// ```
///
/// # Errors
/// [`ReportError::Data`] if the results of the last run are not whole.
pub fn peers() -> Result<Vec<(&'static str, String)>, ReportError> {
    peers::files()
}

/// One drop in time, as [`drop_svg`] draws it.
#[derive(Debug, Clone, Copy)]
pub struct Drop<'a> {
    /// What the model keeps, in a few words.
    pub model: &'a str,
    /// Heights, velocities and, where contacts take time, accelerations and forces over time.
    pub rows: &'a [clatter_flight::history::Row],
    /// The strikes.
    pub strikes: &'a [clatter_flight::Strike],
    /// How long each strike presses, where contacts take time; else empty.
    pub pulses: &'a [clatter_flight::Press],
    /// How it ends.
    pub stop: clatter_flight::Stop,
    /// Positions on the body, in [−1, 1], whose shocks are shown too.
    pub at: &'a [f64],
}

/// A drop as a picture: heights of both ends over time with the strikes marked, the velocity shocks below, and, where
/// contacts take time, forces and accelerations below these. Where the later strikes come much later than the first,
/// the first stand beside the whole, magnified.
///
/// ```
/// use clatter_flight::{Body, Model, Scene};
/// let scene = Scene::new(Body::new(0.14, 0.04)?, 0.3, 4.43, 5.0, 9.81)?;
/// let flight = scene.simulate(Model::FiniteTilt);
/// let rows: Vec<_> = scene.history(Model::FiniteTilt, &flight).collect();
/// let (strikes, stop) = (&flight.strikes, flight.stop);
/// let drop = clatter_report::Drop { model: "finite tilt", rows: &rows, strikes, pulses: &[], stop, at: &[0.0] };
/// assert!(clatter_report::drop_svg(&drop).contains("at rest"));
/// # Ok::<(), clatter::Error>(())
/// ```
#[must_use]
pub fn drop_svg(drop: &Drop<'_>) -> String {
    figure::drop::drop(drop)
}

/// A shock response spectrum on log-log paper, with a limit and the least margin if there is one; the pseudo-velocity
/// on four-coordinate paper, whose diagonals are relative displacement and acceleration.
///
/// ```
/// use clatter_shock::{DampingRatio, Frequencies, Quantity, VelocityShock, VelocityShocks};
/// let shock = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?;
/// let frequencies = Frequencies::per_octave(10.0, 1000.0, 12.0)?;
/// let spectrum = shock.spectrum(&frequencies, DampingRatio::new(0.05)?, Quantity::PseudoVelocity);
/// assert!(clatter_report::spectrum_svg(&spectrum, None).contains("pseudo-velocity"));
/// # Ok::<(), clatter_shock::Error>(())
/// ```
#[must_use]
pub fn spectrum_svg(spectrum: &clatter_shock::Spectrum, limit: Option<&clatter_shock::LimitCurve>) -> String {
    figure::shock::spectrum(spectrum, limit)
}

/// A damage boundary: acceleration over velocity change, log-log, `curve` from [`clatter_shock::DamageBoundary::curve`]
/// and a pulse at (velocity change, acceleration) on it.
#[must_use]
pub fn damage_boundary_svg(boundary: &clatter_shock::DamageBoundary, curve: &[(f64, f64)], pulse: [f64; 2]) -> String {
    figure::shock::damage_boundary(boundary, curve, pulse)
}

/// The three-way rule as one spectrum over ω h0/v0 with its asymptotes, and a component at (ω h0/v0, |A|/(ω v0)) on it.
#[must_use]
pub fn rule_svg(rule: &clatter_shock::Rule, component: [f64; 2]) -> String {
    figure::shock::rule(rule, component)
}
