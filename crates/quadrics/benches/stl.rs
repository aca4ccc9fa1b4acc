//! `format/stl.rs`: binary STL, welded.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::{format, synth};

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("stl");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let mesh = synth::part("demo", faces).expect("the catalogue has it").mesh;
        let bytes = format::write("stl", &mesh).expect("a part fits into an STL");
        let read = || format::read("stl", &bytes, &mut |_| None).expect("it was just written");
        assert_eq!(read().mesh.positions.len(), mesh.positions.len());
        group.throughput(Throughput::Bytes(bytes.len() as u64));
        group.bench_function(BenchmarkId::from_parameter(faces), |bencher| bencher.iter(read));
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
