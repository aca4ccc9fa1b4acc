//! `prepare/normals.rs`: three rounds of filtering.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::Working;
use quadrics::prepare::normals::{Rings, filter};
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("normals");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let fine = Working::new(synth::part("demo", faces).expect("the catalogue has it").mesh);
        let rings = Rings::new(&fine.mesh, &fine.adjacency);
        let filtered = filter(&fine.geometry, &rings, 3, 0.3);
        assert!(filtered.iter().all(|normal| (normal.norm() - 1.0).abs() < 1e-9));
        group.throughput(Throughput::Elements(fine.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &fine, |bencher, fine| {
            bencher.iter(|| filter(&fine.geometry, &rings, 3, 0.3));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
