//! `prepare/coarsen.rs`: a tenth of the faces.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::Working;
use quadrics::prepare::coarsen;
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("coarsen");
    group.sample_size(10);
    for faces in [100_000, 1_000_000] {
        let fine = Working::new(synth::part("demo", faces).expect("the catalogue has it").mesh);
        let found = coarsen(&fine, faces / 10).mesh.faces.len();
        assert!((faces / 20..faces / 5).contains(&found), "{found} faces");
        group.throughput(Throughput::Elements(fine.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &fine, |bencher, fine| {
            bencher.iter(|| coarsen(fine, faces / 10));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
