//! Which of many balls are near a point or a ball: the index that all searches for neighbours use.
//!
//! Each body is known by a ball around it. The balls are kept in an R-tree by their bounding boxes,
//! so that a search costs about the logarithm of the number of balls, however much their sizes
//! differ.

use nalgebra::{Point3, Vector3};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A ball: centre and radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre.
    pub center: Point3<f64>,
    /// The radius.
    pub radius: f64,
}

impl Ball {
    /// A ball with the same centre, its radius larger by `reach`.
    #[must_use]
    pub fn grown(self, reach: f64) -> Self {
        Self {
            radius: self.radius + reach,
            ..self
        }
    }

    fn bounds(&self) -> AABB<[f64; 3]> {
        let corner = Vector3::repeat(self.radius);
        AABB::from_corners((self.center - corner).into(), (self.center + corner).into())
    }
}

/// Balls in free space, to be searched by place.
#[derive(Clone, Debug)]
pub struct Neighbours {
    balls: Vec<Ball>,
    tree: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>,
}

impl Neighbours {
    /// The index of some balls.
    pub fn new(balls: impl IntoIterator<Item = Ball>) -> Self {
        let balls: Vec<Ball> = balls.into_iter().collect();
        let boxes = balls.iter().enumerate();
        let boxes = boxes.map(|(index, ball)| GeomWithData::new(ball.bounds().into(), index));
        Self {
            tree: RTree::bulk_load(boxes.collect()),
            balls,
        }
    }

    /// The balls, in the order in which they were given.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// The balls that `ball` touches or overlaps, in ascending order of their index.
    pub fn touching(&self, ball: Ball) -> Vec<usize> {
        let candidates = self.tree.locate_in_envelope_intersecting(&ball.bounds());
        let touches = |index: &usize| {
            let other = &self.balls[*index];
            (other.center - ball.center).norm() <= other.radius + ball.radius
        };
        let mut found: Vec<usize> = candidates.map(|it| it.data).filter(touches).collect();
        found.sort_unstable();
        found
    }

    /// The balls that hold a point, in ascending order of their index.
    pub fn holding(&self, point: Point3<f64>) -> Vec<usize> {
        self.touching(Ball {
            center: point,
            radius: 0.0,
        })
    }

    /// The pairs of balls that touch or overlap, the smaller index first, in ascending order.
    pub fn pairs(&self) -> Vec<[usize; 2]> {
        let partners = |(index, &ball): (usize, &Ball)| {
            let found = self.touching(ball).into_iter();
            found
                .filter(move |&other| other > index)
                .map(move |other| [index, other])
        };
        self.balls.iter().enumerate().flat_map(partners).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every search finds what comparing with all balls finds.
    #[test]
    fn finds_what_all_comparisons_find() {
        let mut chance = fastrand::Rng::with_seed(3);
        let balls: Vec<Ball> = (0..600)
            .map(|_| Ball {
                center: Point3::from([(); 3].map(|()| 10.0 * chance.f64())),
                radius: 10f64.powf(-2.0 + 2.0 * chance.f64()),
            })
            .collect();
        let neighbours = Neighbours::new(balls.iter().copied());
        let touch = |a: &Ball, b: &Ball| (a.center - b.center).norm() <= a.radius + b.radius;
        let mut pairs = Vec::new();
        for (i, ball) in balls.iter().enumerate() {
            let all: Vec<usize> = (0..balls.len())
                .filter(|&j| touch(ball, &balls[j]))
                .collect();
            assert_eq!(neighbours.touching(*ball), all);
            pairs.extend(all.iter().filter(|&&j| j > i).map(|&j| [i, j]));
        }
        assert_eq!(neighbours.pairs(), pairs);
        assert!(pairs.len() > 100);
        let point = balls[7].center;
        assert!(neighbours.holding(point).contains(&7));
        assert!(Neighbours::new([]).holding(point).is_empty());
    }
}
