use std::ops::Range;

use proptest::prelude::*;

use super::*;

const COSTS: Costs = Costs {
    pair: 1.2,
    grid: 350_000.0,
    point: 300.0,
};

fn random(rng: &mut fastrand::Rng) -> [f64; 3] {
    std::array::from_fn(|_| rng.f64())
}

fn direction(rng: &mut fastrand::Rng) -> [f64; 3] {
    loop {
        let x = random(rng).map(|x| 2.0 * x - 1.0);
        let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        if r > 0.1 && r < 1.0 {
            return x.map(|x| x / r);
        }
    }
}

/// Points of one of several shapes.
fn cloud(shape: usize, n: usize, rng: &mut fastrand::Rng) -> Vec<[f64; 3]> {
    let centers = [[1e10, 1e10, 1e10], [-1.0, 0.5, 2.0]];
    (0..n)
        .map(|i| {
            let x = random(rng);
            match shape {
                0 => x,
                1 => direction(rng),
                2 => [0.3 * x[0], 0.3 * x[0], 0.3 * x[0]],
                3 => [x[0], 0.5, x[1]],
                // Clusters 1e6 of their sizes apart, with structure.
                4 => std::array::from_fn(|axis| (i % 2) as f64 + 1e-6 * x[axis] * x[axis]),
                5 => [0.1, 0.2, 0.3],
                // Clusters of coincident points.
                6 => [(i % 3) as f64, 0.0, (i % 2) as f64],
                // At the rounding of the coordinates.
                7 => std::array::from_fn(|axis| centers[0][axis] + 1e-5 * x[axis]),
                8 => std::array::from_fn(|axis| x[axis].powi(20)),
                _ => std::array::from_fn(|axis| 1e-300 * x[axis] + centers[1][axis]),
            }
        })
        .collect()
}

fn usizes(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

/// The gridded boxes, one of each level, that hold a point.
fn boxes_of(tree: &Tree, i: usize, range: fn(&GriddedBox) -> &Range<u32>) -> Vec<u32> {
    let holds = |one: &GriddedBox| range(one).contains(&(i as u32));
    tree.levels
        .iter()
        .map_while(|level| level.boxes.iter().position(holds))
        .map(|i| i as u32)
        .collect()
}

fn leaves_of(tree: &Tree, n: usize, range: fn(&Leaf) -> &Range<u32>) -> Vec<usize> {
    let mut holder = vec![usize::MAX; n];
    for (i, leaf) in tree.leaves.iter().enumerate() {
        for point in usizes(range(leaf)) {
            assert_eq!(holder[point], usize::MAX, "a point is in one leaf");
            holder[point] = i;
        }
    }
    assert!(
        holder.iter().all(|&leaf| leaf != usize::MAX),
        "every point is in a leaf"
    );
    holder
}

fn check_boxes(tree: &Tree) {
    assert_eq!(tree.levels[0].boxes.len(), 1);
    assert_eq!(
        tree.levels[0].boxes[0].sources,
        0..tree.sources.order.len() as u32
    );
    assert_eq!(
        tree.levels[0].boxes[0].targets,
        0..tree.target_points().order.len() as u32
    );
    let root = &tree.levels[0].boxes[0];
    let mut leaves = 0;
    for (depth, level) in tree.levels.iter().enumerate() {
        assert_eq!(level.side, tree.levels[0].side / 2f64.powi(depth as i32));
        for (i, one) in level.boxes.iter().enumerate() {
            // Centres are exact: sums without rounding give their differences.
            for axis in 0..3 {
                let steps = (2 * one.place[axis] + 1) as f64 - 2f64.powi(depth as i32);
                assert_eq!(
                    one.center[axis] - root.center[axis],
                    steps * 0.5 * level.side
                );
            }
            for (points, range) in [
                (&tree.sources, &one.sources),
                (tree.target_points(), &one.targets),
            ] {
                for point in usizes(range) {
                    for axis in 0..3 {
                        let x = points.positions[axis][point];
                        let slack = 4.0 * f64::EPSILON * (x.abs() + tree.levels[0].side);
                        assert!((x - one.center[axis]).abs() <= 0.5 * level.side + slack);
                    }
                }
            }
            let mut family: Vec<_> = Vec::new();
            for child in usizes(&one.children) {
                let child_box = &tree.levels[depth + 1].boxes[child];
                assert_eq!(child_box.parent, i as u32);
                for axis in 0..3 {
                    assert_eq!(
                        child_box.place[axis],
                        2 * one.place[axis] + i64::from(child_box.octant >> axis & 1)
                    );
                }
                family.push((child_box.sources.clone(), child_box.targets.clone()));
            }
            for leaf in &tree.leaves[usizes(&one.leaves)] {
                assert!(!leaf.sources.is_empty() || !leaf.targets.is_empty());
                family.push((leaf.sources.clone(), leaf.targets.clone()));
            }
            leaves += one.leaves.len();
            family.sort_by_key(|(sources, targets)| {
                (sources.start, sources.end, targets.start, targets.end)
            });
            let mut end = (one.sources.start, one.targets.start);
            for (sources, targets) in family {
                assert_eq!(
                    (sources.start, targets.start),
                    end,
                    "children tile their parent"
                );
                end = (sources.end, targets.end);
            }
            assert_eq!(end, (one.sources.end, one.targets.end));
        }
    }
    assert_eq!(leaves, tree.leaves.len());
}

/// Every pair once, by the residual that completes the sum of the difference kernels it sees.
fn check_pairs(tree: &Tree) {
    let sources = tree.sources.order.len();
    let targets = tree.target_points().order.len();
    let source_leaves = leaves_of(tree, sources, |leaf| &leaf.sources);
    let target_leaves = leaves_of(tree, targets, |leaf| &leaf.targets);
    let source_boxes: Vec<_> = (0..sources)
        .map(|i| boxes_of(tree, i, |one| &one.sources))
        .collect();
    let target_boxes: Vec<_> = (0..targets)
        .map(|i| boxes_of(tree, i, |one| &one.targets))
        .collect();
    let mut pairs = 0.0;
    let mut sides = vec![0.0; tree.leaves.len()];
    for level in &tree.levels {
        for one in &level.boxes {
            sides[usizes(&one.leaves)].fill(0.5 * level.side);
        }
    }
    for i in 0..targets {
        let leaf = &tree.leaves[target_leaves[i]];
        for j in 0..sources {
            let r2: f64 = (0..3)
                .map(|axis| {
                    (tree.target_points().positions[axis][i] - tree.sources.positions[axis][j])
                        .powi(2)
                })
                .sum();
            let length = sides[target_leaves[i]].max(sides[source_leaves[j]]);
            pairs += f64::from(u8::from(r2 < length * length));
            let found: Vec<_> = leaf
                .near
                .iter()
                .filter(|near| near.sources.contains(&(j as u32)))
                .collect();
            assert!(found.len() <= 1);
            if r2 < length * length * (1.0 - 1e-12) {
                assert_eq!(found.len(), 1, "within reach");
            }
            if let Some(near) = found.first() {
                assert_eq!(near.reach, length);
            }
            // The differences telescope from the root's length to half the side of the last box,
            // unless the pair is beyond.
            let mut remaining = tree.levels[0].side / 2.0;
            for level in 1..source_boxes[j].len().min(target_boxes[i].len()) {
                let place = |number: u32| tree.levels[level].boxes[number as usize].place;
                let (a, b) = (place(target_boxes[i][level]), place(source_boxes[j][level]));
                if (0..3).any(|axis| (a[axis] - b[axis]).abs() > 1) {
                    assert!(r2 >= (tree.levels[level].side).powi(2) * (1.0 - 1e-12));
                    break;
                }
                assert_eq!(remaining, tree.levels[level].side);
                remaining /= 2.0;
            }
            if r2 < length * length * (1.0 - 1e-12) {
                assert_eq!(remaining, length);
            }
        }
    }
    assert_eq!(tree.pairs(), pairs);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn pairs_are_covered_once(
        shape in 0..10usize,
        target_shape in 0..14usize,
        n in 0..300usize,
        grid in 0.0..4.0f64,
        seed: u64,
    ) {
        let rng = &mut fastrand::Rng::with_seed(seed);
        let sources = cloud(shape, n, rng);
        let targets = (target_shape < 10).then(|| cloud(target_shape, rng.usize(0..300), rng));
        let costs = Costs { pair: 1.0, grid: 10f64.powf(grid), point: 1.0 };
        for root in Root::candidates(&sources, targets.as_deref()) {
            let tree = Tree::inside(&root, &sources, targets.as_deref(), &costs);
            check_boxes(&tree);
            check_pairs(&tree);
        }
    }
}

#[test]
fn points_keep_their_numbers() {
    let rng = &mut fastrand::Rng::with_seed(1);
    for shape in 0..10 {
        let sources = cloud(shape, 1000, rng);
        let tree = Tree::new(&sources, None, &COSTS);
        let mut seen = vec![false; sources.len()];
        for (i, &number) in tree.sources.order.iter().enumerate() {
            assert!(!std::mem::replace(&mut seen[number as usize], true));
            assert_eq!(
                tree.sources.positions.each_ref().map(|x| x[i]),
                sources[number as usize]
            );
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let rng = &mut fastrand::Rng::with_seed(2);
    for shape in 0..10 {
        let points = cloud(shape, 20_000, rng);
        let costs = Costs { grid: 3e4, ..COSTS };
        let tree = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            format!("{:?}", pool.install(|| Tree::new(&points, None, &costs)))
        };
        assert!(tree(1) == tree(3));
    }
}

/// Surfaces of spheroids of semi-axes 0.5, 0.5, 1, of 2550 points each, in random orientations on a
/// jittered lattice.
fn spheroids(n: usize, rng: &mut fastrand::Rng) -> Vec<[f64; 3]> {
    let bodies = n / 2550;
    let row = (bodies as f64).cbrt().ceil() as usize;
    let mut points = Vec::new();
    for body in 0..bodies {
        let axis = direction(rng);
        let jitter = random(rng);
        let place = [body % row, body / row % row, body / row / row];
        let center: [f64; 3] = std::array::from_fn(|i| 2.4 * place[i] as f64 + 0.3 * jitter[i]);
        for _ in 0..2550 {
            let x = direction(rng);
            let along: f64 = (0..3).map(|i| x[i] * axis[i]).sum();
            points.push(std::array::from_fn(|i| {
                center[i] + 0.5 * x[i] + 0.5 * along * axis[i]
            }));
        }
    }
    points
}

/// The tree with all boxes of `depth` levels gridded.
fn uniform(points: &[[f64; 3]], root: &Root, depth: usize) -> Tree {
    let (sources, keys) = sorting::sorted(points, root);
    let keys = Keys {
        sources: &keys,
        targets: None,
    };
    let cells = Cells::uniform(&keys, depth);
    let (levels, mut leaves) = cells.boxes_and_leaves(root);
    near::fill(&mut leaves, &cells, root, &sources, None);
    Tree {
        sources,
        targets: None,
        levels,
        leaves,
    }
}

#[test]
fn refinement_pays() {
    let rng = &mut fastrand::Rng::with_seed(4);
    for n in [2_000, 10_000, 40_000] {
        for points in [
            cloud(0, n, rng),
            cloud(1, n, rng),
            cloud(2, n, rng),
            spheroids(n.max(2550), rng),
        ] {
            let cost = Tree::new(&points, None, &COSTS).cost(&COSTS);
            for root in Root::candidates(&points, None) {
                for depth in 1..5 {
                    assert!(cost < 1.1 * uniform(&points, &root, depth).cost(&COSTS));
                }
            }
        }
    }
}

#[test]
fn distant_clusters_are_reached_and_coincident_points_are_not_split() {
    let rng = &mut fastrand::Rng::with_seed(5);
    let clusters = Tree::new(&cloud(4, 20_000, rng), None, &COSTS);
    assert!(clusters.pairs() < 2000.0 * 20_000.0);
    assert_eq!(
        Tree::new(&cloud(5, 20_000, rng), None, &COSTS).levels.len(),
        1
    );
    assert!(Tree::new(&cloud(6, 20_000, rng), None, &COSTS).levels.len() <= 3);
}
