//! contact

mod gap;
mod joint;
mod law;
mod overlap;

pub use gap::{Gap, Kind, Pair, Pose};
pub use joint::{COUPLED, FORCES, Joint, JointResponse, Level};
pub use law::{Approach, ContactLaw, InvalidLaw, Law};
pub use overlap::{Overlap, overlap_polygon, overlaps};
