//! `surface/refine.rs`: orthogonal-distance fits of a cylinder to noisy points.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::math::{Point, Vector};
use quadrics::surface::{Cylinder, Surface, refine};

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("refine");
    group.sample_size(10);
    for count in [100, 1_000, 10_000] {
        let point = |i: usize| {
            let (turn, height) = (i as f64 * 0.7, i as f64 * 0.31 % 1.0);
            let radius = 0.3 + 1e-3 * (i as f64 * 1.9).sin();
            Point::new(radius * turn.cos(), radius * turn.sin(), height)
        };
        let points: Vec<Point> = (0..count).map(point).collect();
        let start =
            Cylinder { point: Point::new(0.02, 0.0, 0.0), axis: Vector::z_axis(), radius: 0.28 };
        let start = Surface::Cylinder(start);
        let found = refine(&start, &points, &[]).expect("it is a cylinder").surface;
        assert!(matches!(found, Surface::Cylinder(found) if (found.radius - 0.3).abs() < 1e-3));
        group.throughput(Throughput::Elements(count as u64));
        group.bench_with_input(BenchmarkId::from_parameter(count), &points, |bencher, points| {
            bencher.iter(|| refine(&start, points, &[]));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
