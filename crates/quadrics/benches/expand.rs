//! `recognise/expand.rs`: expansion moves from the truth under noise.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::Working;
use quadrics::partition::Regions;
use quadrics::recognise::assign::{Model, models};
use quadrics::recognise::expand::expand;
use quadrics::recognise::scene::Scene;
use quadrics::synth::{self, Noise};
use quadrics::{Context, prepare};

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("expand");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let part = synth::part("demo", faces).expect("the catalogue has it");
        let into = prepare::to_unit_cube(&part.mesh).expect("a part has an extent");
        let part = part.transformed(&into);
        let noise = Noise::uniform(0.002, 0.9);
        let noisy = synth::add_noise(&mut Context::new(0), &part.mesh, &noise);
        let working = Working::new(noisy.expect("the noise is in range"));
        let scene = Scene::new(&working);
        let models: Vec<Model> = models(&scene, &Regions::new(&part.labels), part.surfaces.iter());
        let moved = {
            let mut labels = part.labels.clone();
            expand(&scene, &models, &mut labels);
            labels.iter().zip(&part.labels).filter(|(new, old)| new != old).count()
        };
        assert!(moved * 10 < faces, "{moved} faces left the truth");
        group.throughput(Throughput::Elements(working.len() as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(faces),
            &part.labels,
            |bencher, labels| {
                bencher.iter(|| {
                    let mut labels = labels.clone();
                    expand(&scene, &models, &mut labels);
                    labels
                });
            },
        );
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
