//! `partition.rs`: connected components of a true partition.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::Adjacency;
use quadrics::partition::components;
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("partition");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let part = synth::part("demo", faces).expect("the catalogue has it");
        let adjacency = Adjacency::new(&part.mesh.faces, part.mesh.positions.len());
        assert_eq!(components(&part.labels, &adjacency).1.len(), part.surfaces.len());
        group.throughput(Throughput::Elements(part.labels.len() as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(faces),
            &part.labels,
            |bencher, labels| {
                bencher.iter(|| components(labels, &adjacency));
            },
        );
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
