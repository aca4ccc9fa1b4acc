//! `prepare/order.rs`: vertices and faces by place.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::prepare::{ordered, to_unit_cube};
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("order");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let mut mesh = synth::part("demo", faces).expect("the catalogue has it").mesh;
        let into = to_unit_cube(&mesh).expect("a part has an extent");
        mesh.positions.iter_mut().for_each(|point| *point = into * *point);
        let once = ordered(&mesh);
        assert_eq!(ordered(&once.mesh).mesh, once.mesh);
        group.throughput(Throughput::Elements(mesh.faces.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &mesh, |bencher, mesh| {
            bencher.iter(|| ordered(mesh));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
