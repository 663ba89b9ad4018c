//! How a long computation tells where it is.

/// Receives the progress of a computation; called from any thread.
pub trait Progress: Sync {
    /// A stage of the given number of steps begins; the stage before it has ended.
    fn begin(&self, stage: &'static str, steps: usize);

    /// This many more steps of the stage are done.
    fn advance(&self, steps: usize);

    /// One of several like questions begins, the `number`-th (from 1) of `of`.
    fn begin_question(&self, _what: &'static str, _number: usize, _of: usize) {}

    /// A solution begins, the `round`-th (from 1) to its question. The one before it has this
    /// estimated error, and is not good enough.
    fn begin_round(&self, _round: usize, _error_estimate: Option<f64>) {}

    /// Whether the computation should stop: long ones end with an error soon after.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _stage: &'static str, _steps: usize) {}

    fn advance(&self, _steps: usize) {}
}
