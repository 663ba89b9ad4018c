//! The panels that cover a curve: even ones, bisected ones, graded ones.

use super::arc_length::arc_length;
use super::error::CurveError;
use super::generating_curve::{GeneratingCurve, Topology};
use super::panel::Panel;
use super::shares::shares;

/// Most panels that one curve may have.
pub const MOST_PANELS: usize = 100_000;

/// Panels that cover a curve, in order, none across a breakpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Panels {
    panels: Vec<Panel>,
    topology: Topology,
}

impl Panels {
    /// One panel for each smooth piece.
    ///
    /// # Errors
    /// If the curve's breakpoints are not ascending finite numbers, or more than [`MOST_PANELS`].
    pub fn pieces(curve: &(impl GeneratingCurve + ?Sized)) -> Result<Self, CurveError> {
        let breakpoints = curve.breakpoints();
        let panels: Vec<Panel> = breakpoints
            .windows(2)
            .enumerate()
            .map(|(piece, ends)| Panel {
                start: ends[0],
                end: ends[1],
                piece,
            })
            .collect();
        let ascending = panels.iter().all(|panel| {
            // Wide enough to be bisected a few times.
            let size = panel.start.abs().max(panel.end.abs());
            panel.length().is_finite() && panel.length() > 1e-12 * size
        });
        if panels.is_empty() || !ascending {
            return Err(CurveError::Domain);
        }
        if panels.len() > MOST_PANELS {
            return Err(CurveError::PanelCount {
                count: panels.len(),
                least: 1,
                limit: MOST_PANELS,
            });
        }
        Ok(Self {
            panels,
            topology: curve.topology(),
        })
    }

    /// `count` panels, equal in the parameter within each smooth piece; pieces get panels such that
    /// the longest panel (by arc length) is as short as possible, and at least one.
    ///
    /// # Errors
    /// If `count` is less than the number of pieces, or more than [`MOST_PANELS`].
    pub fn uniform(
        curve: &(impl GeneratingCurve + ?Sized),
        count: usize,
    ) -> Result<Self, CurveError> {
        Self::divided(curve, count, |piece, parts, k| {
            piece.start + piece.length() * k as f64 / parts as f64
        })
    }

    /// `count` panels of equal arc length within each smooth piece, shared among the pieces like
    /// [uniform](Self::uniform) ones: where the parameter runs faster here than there, these
    /// resolve more with as many.
    ///
    /// # Errors
    /// If `count` is less than the number of pieces, or more than [`MOST_PANELS`].
    pub fn equal_arcs(
        curve: &(impl GeneratingCurve + ?Sized),
        count: usize,
    ) -> Result<Self, CurveError> {
        Self::divided(curve, count, |piece, parts, k| {
            let wanted = arc_length(curve, piece.start, piece.end) * k as f64 / parts as f64;
            // Arc length grows with the parameter: bisection to rounding.
            let (mut low, mut high) = (piece.start, piece.end);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if arc_length(curve, piece.start, middle) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            0.5 * (low + high)
        })
    }

    /// `count` panels, with inner end number `k` of the `parts` of a piece where `end` puts it.
    fn divided(
        curve: &(impl GeneratingCurve + ?Sized),
        count: usize,
        end: impl Fn(&Panel, usize, usize) -> f64,
    ) -> Result<Self, CurveError> {
        let pieces = Self::pieces(curve)?;
        let least = pieces.len();
        if count < least || count > MOST_PANELS {
            return Err(CurveError::PanelCount {
                count,
                least,
                limit: MOST_PANELS,
            });
        }
        let lengths: Vec<f64> = pieces
            .iter()
            .map(|piece| arc_length(curve, piece.start, piece.end))
            .collect();
        let counts = shares(&lengths, count);
        let mut panels = Vec::with_capacity(count);
        for (piece, &parts) in pieces.iter().zip(&counts) {
            let mut start = piece.start;
            for k in 1..=parts {
                let end = if k == parts {
                    piece.end
                } else {
                    end(piece, parts, k)
                };
                panels.push(Panel {
                    start,
                    end,
                    ..*piece
                });
                start = end;
            }
        }
        Ok(Self {
            panels,
            topology: pieces.topology,
        })
    }

    /// The same panels, with those whose index `which` picks cut in two equal halves.
    #[must_use]
    pub fn bisected(&self, which: impl Fn(usize) -> bool) -> Self {
        let mut panels = Vec::with_capacity(self.len());
        for (index, panel) in self.panels.iter().enumerate() {
            if which(index) {
                panels.extend(panel.halves());
            } else {
                panels.push(*panel);
            }
        }
        Self {
            panels,
            topology: self.topology,
        }
    }

    /// The same panels, bisected until none is more than twice as long (in the parameter) as a
    /// neighbour on the same smooth piece; a loop of one piece is smooth across its seam too.
    #[must_use]
    pub fn graded(&self) -> Self {
        // A little more than 2, so that roundings of the ends do not count.
        let limit = 2.0 * (1.0 + 1e-6);
        let mut result = self.clone();
        loop {
            let marks: Vec<bool> = (0..result.len())
                .map(|index| {
                    let length = result.panels[index].length();
                    result
                        .neighbours(index)
                        .into_iter()
                        .flatten()
                        .any(|n| length > limit * n.length())
                })
                .collect();
            if !marks.contains(&true) {
                return result;
            }
            result = result.bisected(|index| marks[index]);
        }
    }

    /// The same panels, [graded](Self::graded), and bisected at each joint of two smooth pieces
    /// until neither arc beside the joint is more than twice as long as the other: a density that
    /// varies over a short arc varies as fast just beyond the joint.
    #[must_use]
    pub fn graded_across_joints(&self, curve: &(impl GeneratingCurve + ?Sized)) -> Self {
        let mut result = self.graded();
        loop {
            let last = result.len() - 1;
            let arc = |i: usize| arc_length(curve, result.panels[i].start, result.panels[i].end);
            let mut marks = vec![false; result.len()];
            for i in 0..result.len() {
                let next = if i < last { i + 1 } else { 0 };
                let seam = next == 0;
                if result.panels[i].piece == result.panels[next].piece
                    || (seam && self.topology != Topology::Loop)
                {
                    continue;
                }
                let (before, after) = (arc(i), arc(next));
                marks[i] |= before > 2.0 * after * (1.0 + 1e-6);
                marks[next] |= after > 2.0 * before * (1.0 + 1e-6);
            }
            if !marks.contains(&true) || result.len() > MOST_PANELS / 2 {
                return result;
            }
            result = result.bisected(|index| marks[index]).graded();
        }
    }

    /// The same panels, those at a joint of two smooth pieces bisected towards it `levels` times:
    /// there the density is not smooth (a capsule's curvature jumps). Each round halves the panels
    /// at the joints.
    ///
    /// Panels shorter than 1e-10 of the domain are not cut further.
    #[must_use]
    pub fn graded_to_breakpoints(&self, levels: usize) -> Self {
        let domain = self.panels.iter().map(Panel::length).sum::<f64>();
        let mut result = self.clone();
        for _ in 0..levels {
            let cut =
                |i: usize| result.touches_joint(i) && result.panels[i].length() > 1e-10 * domain;
            let next = result.bisected(cut);
            if next.len() == result.len() {
                break;
            }
            result = next;
        }
        result.graded()
    }

    /// The panels as a slice.
    pub fn as_slice(&self) -> &[Panel] {
        &self.panels
    }

    /// The panels, in the order of the parameter.
    pub fn iter(&self) -> std::slice::Iter<'_, Panel> {
        self.panels.iter()
    }

    /// How many panels there are.
    pub fn len(&self) -> usize {
        self.panels.len()
    }

    /// Whether there is no panel (never).
    pub fn is_empty(&self) -> bool {
        self.panels.is_empty()
    }

    /// How the curve closes.
    pub fn topology(&self) -> Topology {
        self.topology
    }

    /// The neighbours on the same smooth piece, before and after.
    fn neighbours(&self, index: usize) -> [Option<&Panel>; 2] {
        let last = self.panels.len() - 1;
        let piece = self.panels[index].piece;
        let wraps = self.topology == Topology::Loop && self.panels[last].piece == 0;
        let before = if index > 0 {
            Some(index - 1)
        } else {
            wraps.then_some(last)
        };
        let after = if index < last {
            Some(index + 1)
        } else {
            wraps.then_some(0)
        };
        [before, after].map(|n| n.map(|n| &self.panels[n]).filter(|n| n.piece == piece))
    }

    /// Whether an end of the panel is a joint of two pieces; on a loop of several pieces the seam
    /// is one.
    fn touches_joint(&self, index: usize) -> bool {
        let last = self.panels.len() - 1;
        let differs = |other: usize| self.panels[other].piece != self.panels[index].piece;
        let closed = self.topology == Topology::Loop;
        let before = if index > 0 {
            differs(index - 1)
        } else {
            closed && differs(last)
        };
        let after = if index < last {
            differs(index + 1)
        } else {
            closed && differs(0)
        };
        before || after
    }
}

impl<'a> IntoIterator for &'a Panels {
    type Item = &'a Panel;
    type IntoIter = std::slice::Iter<'a, Panel>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::super::{Capsule, Spheroid, Torus};
    use super::*;

    fn counts(panels: &Panels) -> Vec<usize> {
        let pieces = panels.iter().map(|p| p.piece).max().unwrap() + 1;
        (0..pieces)
            .map(|k| panels.iter().filter(|p| p.piece == k).count())
            .collect()
    }

    #[test]
    fn uniform_panels_cover_the_curve() {
        let sphere = Spheroid::sphere(1.0).unwrap();
        let panels = Panels::uniform(&sphere, 8).unwrap();
        assert_eq!(panels.len(), 8);
        assert_eq!(panels.as_slice()[0].start, 0.0);
        assert_eq!(panels.as_slice()[7].end, PI);
        assert!(
            panels
                .as_slice()
                .windows(2)
                .all(|pair| pair[0].end == pair[1].start)
        );
        assert!(
            panels
                .iter()
                .all(|panel| (panel.length() - PI / 8.0).abs() < 1e-15)
        );
        let panel = panels.as_slice()[3];
        assert_eq!((panel.at(-1.0), panel.at(1.0)), (panel.start, panel.end));
        assert!((panel.at(0.0) - 0.5 * (panel.start + panel.end)).abs() < 1e-15);
    }

    #[test]
    fn pieces_share_by_arc_length() {
        let long = Capsule::new(1.0, 20.0).unwrap();
        assert_eq!(counts(&Panels::uniform(&long, 3).unwrap()), [1, 1, 1]);
        assert_eq!(counts(&Panels::uniform(&long, 16).unwrap()), [1, 14, 1]);
        let round = Capsule::new(1.0, FRAC_PI_2).unwrap();
        assert_eq!(counts(&Panels::uniform(&round, 9).unwrap()), [3, 3, 3]);
        assert_eq!(shares(&[1.0, 1e-9, 5.0], 1000).iter().sum::<usize>(), 1000);
        assert_eq!(
            shares(&[f64::NAN, 0.0, f64::INFINITY], 1000)
                .iter()
                .sum::<usize>(),
            1000
        );
    }

    #[test]
    fn impossible_counts_are_refused() {
        let capsule = Capsule::new(1.0, 2.0).unwrap();
        for count in [0, 2, MOST_PANELS + 1, usize::MAX] {
            let error = Panels::uniform(&capsule, count).unwrap_err();
            assert_eq!(
                error,
                CurveError::PanelCount {
                    count,
                    least: 3,
                    limit: MOST_PANELS
                }
            );
        }
    }

    #[test]
    fn grading_keeps_neighbours_within_two() {
        let torus = Torus::new(2.0, 1.0).unwrap();
        let mut panels = Panels::uniform(&torus, 4).unwrap();
        for _ in 0..6 {
            panels = panels.bisected(|index| index == 0);
        }
        let graded = panels.graded();
        let lengths: Vec<f64> = graded.iter().map(Panel::length).collect();
        let n = lengths.len();
        assert!((0..n).all(|i| lengths[i] <= 2.001 * lengths[(i + 1) % n]));
        assert!((0..n).all(|i| lengths[(i + 1) % n] <= 2.001 * lengths[i]));
        assert_eq!(graded.graded(), graded);
    }

    #[test]
    fn joints_are_graded_dyadically() {
        let capsule = Capsule::new(1.0, 2.0).unwrap();
        let panels = Panels::uniform(&capsule, 3)
            .unwrap()
            .graded_to_breakpoints(3);
        assert_eq!(counts(&panels), [4, 6, 4]);
        let lengths: Vec<f64> = panels.iter().map(|p| p.length()).collect();
        for (got, expected) in lengths.iter().zip([0.5, 0.25, 0.125, 0.125]) {
            assert!((got - expected * FRAC_PI_2).abs() < 1e-14);
        }
        // A curve without joints stays as it is; absurd levels stop.
        let sphere = Panels::uniform(&Spheroid::sphere(1.0).unwrap(), 5).unwrap();
        assert_eq!(sphere.graded_to_breakpoints(7), sphere);
        assert!(panels.graded_to_breakpoints(usize::MAX).len() < 300);
    }
}
