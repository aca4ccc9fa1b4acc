//! `mesh/repair.rs`: a mesh that needs no repair.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::repair;
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("repair");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let mesh = synth::part("demo", faces).expect("the catalogue has it").mesh;
        let repaired = repair(&mesh).expect("a part is usable");
        assert!(repaired.repairs.is_empty());
        group.throughput(Throughput::Elements(mesh.faces.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &mesh, |bencher, mesh| {
            bencher.iter(|| repair(mesh));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
