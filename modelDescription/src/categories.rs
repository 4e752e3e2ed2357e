//! Categories of log messages, declared in the XML and used by the C boundary.

/// A category of log messages, which an importer can switch on by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// What happens to the wire: a turn has come to rest, a defect was found.
    Events,
    /// The slopes of a directional derivative over small and smaller changes disagree.
    Derivatives,
    /// Where the solver had to search long for a step, and what it did in all.
    Solver,
    /// A call was served, and something about scene, wire or files needs a look.
    Warning,
    /// A step failed, or a status that was asked for is not available.
    Discard,
    /// A call was refused.
    Error,
    /// The instance is lost and can only be freed.
    Fatal,
    /// All categories together, never the category of a message.
    All,
}

/// Every category with its name and description. All names but two are those of the standard (FMI 2.0.5, table in section 2.2.4).
pub(crate) const CATEGORIES: [(Category, &str, &str); 8] = [
    (
        Category::Events,
        "logEvents",
        "Turns that have come to rest, defects found",
    ),
    (
        Category::Derivatives,
        "logDerivatives",
        "Directional derivatives that hold for one size of the change only",
    ),
    (
        Category::Solver,
        "logSolver",
        "Steps that the solver had to search long for; at the end what it did in all",
    ),
    (
        Category::Warning,
        "logStatusWarning",
        "Warnings about the scene, the wire or files",
    ),
    (
        Category::Discard,
        "logStatusDiscard",
        "Failed steps, with time, turn and angle, and information that cannot be given",
    ),
    (
        Category::Error,
        "logStatusError",
        "Refused calls, with the reason",
    ),
    (
        Category::Fatal,
        "logStatusFatal",
        "The instance can only be freed",
    ),
    (Category::All, "logAll", "All messages"),
];

impl Category {
    /// Returns the name that stands in the XML and goes to the importer's logger.
    pub fn name(self) -> &'static str {
        CATEGORIES
            .iter()
            .find(|row| row.0 == self)
            .map_or("logAll", |row| row.1)
    }

    /// Returns the category of a name, or `None` if the name is not declared.
    pub fn by_name(name: &str) -> Option<Self> {
        CATEGORIES.iter().find(|row| row.1 == name).map(|row| row.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_lead_back() {
        for (category, name, _) in CATEGORIES {
            assert_eq!(category.name(), name);
            assert_eq!(Category::by_name(name), Some(category));
        }
        assert_eq!(Category::by_name("logStatusPending"), None);
    }
}
