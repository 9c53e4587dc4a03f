#include "core/untangle/face_nodes.h"

#include <functional>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/basis/reference_element.h"

namespace curvewright {
namespace {

/// A triangle whose nodes are the images of the lattice; those inside it are put somewhere else.
struct Example {
    Coordinates expected, x;
    std::vector<Index> nodes;

    Example(int order, const std::function<Eigen::Vector2d(double, double)>& map) {
        const ReferenceElement& element = reference_element({Shape::triangle, order});
        expected.resize(element.node_count(), 3);
        for (int i = 0; i < element.node_count(); ++i) {
            const Eigen::Vector2d image =
                map(element.lattice[i][0] / double(order), element.lattice[i][1] / double(order));
            expected.row(i) << image[0], image[1], 7.0;
        }
        x = expected;
        for (const int i : element.interior_nodes) x.row(i).head<2>() << 100.0 * i, -50.0;
        nodes.resize(element.node_count());
        std::iota(nodes.begin(), nodes.end(), Index{0});
    }
};

TEST(FaceNodes, ReproduceAffineElementsFarFromTheOriginToo) {
    for (int order = 3; order <= max_order; ++order)
        for (const FaceRule rule : {FaceRule::mean, FaceRule::blend}) {
            if (rule == FaceRule::mean && order > 3) continue;
            for (const double shift : {0.0, 1e6}) {
                Example example(order, [&](double s, double t) {
                    return Eigen::Vector2d(shift + 2.0 + s - 0.4 * t, shift - 1.0 + 0.3 * s + 0.9 * t);
                });
                FaceNodes(order, rule).place(example.nodes, example.x);
                EXPECT_LT((example.x - example.expected).cwiseAbs().maxCoeff(), 1e-14 * (10.0 + shift)) << "P" << order;
            }
        }
}

TEST(FaceNodes, BlendReproducesQuadraticElementsOfEveryOrder) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int order = 3; order <= max_order; ++order) {
        std::array<double, 12> c{};
        for (double& value : c) value = number(random);
        Example example(order, [&](double s, double t) {
            return Eigen::Vector2d(c[0] + c[1] * s + c[2] * t + c[3] * s * s + c[4] * s * t + c[5] * t * t,
                                   c[6] + c[7] * s + c[8] * t + c[9] * s * s + c[10] * s * t + c[11] * t * t);
        });
        FaceNodes(order, FaceRule::blend).place(example.nodes, example.x);
        EXPECT_LT((example.x - example.expected).cwiseAbs().maxCoeff(), 1e-12) << "P" << order;
    }
}

TEST(FaceNodes, BlendExtendsAnEdgeModeOfHigherDegreeAsItShould) {
    // The odd mode s (1 - s) (2 s - 1) of the edge between corners 0 and 1 is l0 l1 (l1 - l0) inside.
    for (int order = 3; order <= max_order; ++order) {
        Example example(order, [](double s, double t) {
            const double l0 = 1.0 - s - t, l1 = s;
            return Eigen::Vector2d(s, t + l0 * l1 * (l1 - l0));
        });
        FaceNodes(order, FaceRule::blend).place(example.nodes, example.x);
        EXPECT_LT((example.x - example.expected).cwiseAbs().maxCoeff(), 1e-12) << "P" << order;
    }
}

TEST(FaceNodes, NothingElseIsWritten) {
    for (int order = 1; order <= max_order; ++order) {
        Example example(order, [](double s, double t) { return Eigen::Vector2d(s / 3.0, t / 7.0 + s * s * t); });
        const FaceNodes face_nodes(order, FaceRule::blend);
        EXPECT_EQ(face_nodes.local_nodes().size(), std::size_t((order - 1) * (order - 2) / 2));
        face_nodes.place(example.nodes, example.x);
        EXPECT_EQ(example.x.col(2), example.expected.col(2));
        for (int i = 0; i < 3 * order; ++i) EXPECT_EQ(example.x.row(i), example.expected.row(i));
    }
}

TEST(FaceNodes, MeanIsRefusedWhereItPutsAllNodesAtOnePoint) {
    EXPECT_THROW(FaceNodes(4, FaceRule::mean), std::invalid_argument);
}

}  // namespace
}  // namespace curvewright
