// CGAL's shape detection on a mesh, as a rival to measure against. See README.md.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/compute_normal.h>
#include <CGAL/Shape_detection/Efficient_RANSAC.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO.h>
#include <CGAL/Variational_shape_approximation.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <CGAL/property_map.h>

#include <sys/resource.h>

#include <cmath>
#include <ctime>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Numbers = std::map<std::string, double>;

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

// Into the unit cube: CGAL compares some squared distances with epsilon.
void scale(Mesh& mesh) {
    CGAL::Bbox_3 box;
    for (auto v : mesh.vertices()) box += mesh.point(v).bbox();
    double longest = 0;
    for (int i = 0; i < 3; ++i) longest = std::max(longest, box.max(i) - box.min(i));
    for (auto v : mesh.vertices()) {
        Point& p = mesh.point(v);
        p = Point((p.x() - box.xmin()) / longest, (p.y() - box.ymin()) / longest, (p.z() - box.zmin()) / longest);
    }
}

std::size_t ransac(const Mesh& mesh, const Numbers& given) {
    using Sample = std::pair<Point, Vector>;
    using Traits = CGAL::Shape_detection::Efficient_RANSAC_traits<
        Kernel, std::vector<Sample>, CGAL::First_of_pair_property_map<Sample>, CGAL::Second_of_pair_property_map<Sample>>;
    std::vector<Sample> samples;
    samples.reserve(mesh.number_of_faces());
    for (auto face : mesh.faces()) {
        auto h = mesh.halfedge(face);
        Point a = mesh.point(mesh.source(h)), b = mesh.point(mesh.target(h)), c = mesh.point(mesh.target(mesh.next(h)));
        samples.emplace_back(CGAL::centroid(a, b, c), CGAL::Polygon_mesh_processing::compute_face_normal(face, mesh));
    }
    CGAL::Shape_detection::Efficient_RANSAC<Traits> detector;
    detector.set_input(samples);
    detector.add_shape_factory<CGAL::Shape_detection::Plane<Traits>>();
    detector.add_shape_factory<CGAL::Shape_detection::Sphere<Traits>>();
    detector.add_shape_factory<CGAL::Shape_detection::Cylinder<Traits>>();
    detector.add_shape_factory<CGAL::Shape_detection::Cone<Traits>>();
    detector.add_shape_factory<CGAL::Shape_detection::Torus<Traits>>();
    typename CGAL::Shape_detection::Efficient_RANSAC<Traits>::Parameters parameters;
    parameters.probability = 0.01;
    parameters.min_points = std::size_t(given.at("min-points"));
    parameters.epsilon = given.at("epsilon");
    parameters.cluster_epsilon = given.at("cluster");
    parameters.normal_threshold = given.at("normal");
    detector.detect(parameters);
    return detector.shapes().size();
}

std::size_t vsa(const Mesh& mesh, const Numbers& given) {
    namespace vsa = CGAL::Surface_mesh_approximation;
    using Points = boost::property_map<Mesh, boost::vertex_point_t>::const_type;
    const Points points = get(boost::vertex_point, mesh);
    const vsa::L21_metric_plane_proxy<Mesh, Points> metric(mesh, points);
    CGAL::Variational_shape_approximation<Mesh, Points> approximation(mesh, points, metric);
    approximation.initialize_seeds(CGAL::parameters::seeding_method(vsa::HIERARCHICAL)
                                       .max_number_of_proxies(std::size_t(given.at("regions"))));
    approximation.run(std::size_t(given.at("iterations")));
    return approximation.number_of_proxies();
}

// Planes only; angles are told by their cosine, as for RANSAC.
std::size_t region_growing(const Mesh& mesh, const Numbers& given) {
    namespace growing = CGAL::Shape_detection;
    using Neighbours = growing::Polygon_mesh::One_ring_neighbor_query<Mesh>;
    using Planes = growing::Polygon_mesh::Least_squares_plane_fit_region<Kernel, Mesh>;
    Neighbours neighbours(mesh);
    const double degrees = std::acos(given.at("normal")) * 180 / CGAL_PI;
    Planes planes(mesh, given.at("epsilon"), degrees, std::size_t(given.at("min-points")),
                  get(CGAL::vertex_point, mesh));
    const Mesh::Face_range faces = mesh.faces();  // It keeps a reference only.
    growing::Region_growing<Mesh::Face_range, Neighbours, Planes> growth(faces, neighbours, planes);
    std::vector<std::vector<std::size_t>> regions;
    growth.detect(std::back_inserter(regions));
    return regions.size();
}

int main(int count, char** words) {
    const std::vector<std::string> arguments(words + 1, words + count);
    Numbers given{{"epsilon", 0.001}, {"normal", 0.8}, {"cluster", 0.025}, {"min-points", 100},
                  {"regions", 40},    {"iterations", 20}, {"seed", 0}};
    const std::map<std::string, std::size_t (*)(const Mesh&, const Numbers&)> methods{
        {"ransac", ransac}, {"vsa", vsa}, {"region-growing", region_growing}};
    bool understood = arguments.size() >= 2 && arguments.size() % 2 == 0 && methods.count(arguments[0]);
    for (std::size_t i = 2; understood && i < arguments.size(); i += 2) {
        understood = arguments[i].substr(0, 2) == "--" && given.count(arguments[i].substr(2));
        if (understood) given[arguments[i].substr(2)] = std::stod(arguments[i + 1]);
    }
    if (!understood) {
        std::cerr << "usage: cgal ransac|vsa|region-growing MESH [--epsilon|normal|cluster|min-points|regions|iterations|seed X]\n";
        return 2;
    }
    Mesh mesh;
    if (!CGAL::IO::read_polygon_mesh(arguments[1], mesh) || mesh.is_empty()) {
        std::cerr << arguments[1] << ": no mesh can be read from it\n";
        return 3;
    }
    scale(mesh);
    CGAL::get_default_random() = CGAL::Random(unsigned(given["seed"]));
    const double read = processor_seconds();
    const std::size_t regions = methods.at(arguments[0])(mesh, given);
    const double end = processor_seconds();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::cout << "{\"method\": \"cgal " << arguments[0] << "\", \"faces\": " << mesh.number_of_faces()
              << ", \"regions\": " << regions << ", \"read_s\": " << read << ", \"algorithm_s\": " << end - read
              << ", \"peak_kb\": " << usage.ru_maxrss << "}\n";
}
