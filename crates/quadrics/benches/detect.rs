//! `recognise/detect.rs`: surfaces of a clean part from nothing.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::Context;
use quadrics::mesh::Working;
use quadrics::prepare::in_own_cube;
use quadrics::recognise::detect::detect;
use quadrics::recognise::scene::Scene;
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("detect");
    group.sample_size(10);
    for faces in [10_000, 100_000] {
        let mesh = synth::part("demo", faces).expect("the catalogue has it").mesh;
        let mesh = in_own_cube(mesh).expect("a part has an extent").0;
        let working = Working::new(mesh);
        let scene = Scene::new(&working);

        let found = detect(&mut Context::new(0), &scene, 1.0);
        let (_, surfaces) = found.expect("nobody cancels").expect("all may stay unexplained");
        assert!(surfaces.len() > 60, "{} surfaces", surfaces.len());
        group.throughput(Throughput::Elements(working.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &scene, |bencher, scene| {
            bencher.iter(|| detect(&mut Context::new(0), scene, 1.0));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
