#include "core/basis/bernstein.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/basis/lagrange.h"

namespace curvewright {
namespace {

double evaluate(const BernsteinSimplex& form, const std::vector<double>& coefficients, const std::array<double, 4>& l) {
    double value = 0.0;
    for (int i = 0; i < form.size(); ++i) {
        double term = coefficients[i] * form.multinomials()[i];
        for (int k = 0; k < 4; ++k)
            for (int power = 0; power < form.indices()[i][k]; ++power) term *= l[k];
        value += term;
    }
    return value;
}

std::array<double, 4> random_point(int dim, std::mt19937& random) {
    std::exponential_distribution<double> exponential;
    std::array<double, 4> l{};
    double sum = 0.0;
    for (int i = 0; i <= dim; ++i) sum += l[i] = exponential(random);
    for (double& v : l) v /= sum;
    return l;
}

TEST(BernsteinSimplex, FunctionsSumToOne) {
    std::mt19937 random(1);
    for (int dim = 1; dim <= 3; ++dim)
        for (int degree : {0, 1, 2, 5, 9}) {
            const auto& form = BernsteinSimplex::get(dim, degree);
            const std::vector<double> ones(form.size(), 1.0);
            EXPECT_NEAR(evaluate(form, ones, random_point(dim, random)), 1.0, 1e-12);
        }
}

TEST(BernsteinSimplex, BisectionKeepsThePolynomial) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (int dim = 1; dim <= 3; ++dim)
        for (int degree : {1, 3, 6})
            for (int a = 0; a <= dim; ++a)
                for (int b = 0; b <= dim; ++b) {
                    if (a == b) continue;
                    const auto& form = BernsteinSimplex::get(dim, degree);
                    std::vector<double> c(form.size()), near_a(form.size()), near_b(form.size());
                    for (double& v : c) v = normal(random);
                    form.bisect(a, b, 1, c.data(), near_a.data(), near_b.data());
                    // A point of the half near a, in the half's own and in the whole's barycentric coordinates.
                    const auto half = random_point(dim, random);
                    auto whole = half;
                    whole[a] += 0.5 * half[b];
                    whole[b] *= 0.5;
                    EXPECT_NEAR(evaluate(form, near_a, half), evaluate(form, c, whole), 1e-12);
                    whole = half;
                    whole[b] += 0.5 * half[a];
                    whole[a] *= 0.5;
                    EXPECT_NEAR(evaluate(form, near_b, half), evaluate(form, c, whole), 1e-12);
                }
}

/// Value of a form at a point given by the barycentric coordinates in every factor.
double evaluate(const BernsteinForm& form, const std::vector<double>& coefficients,
                const std::vector<std::array<double, 4>>& l) {
    std::vector<double> left = coefficients;
    for (std::size_t f = form.factors().size(); f-- > 0;) {
        const BernsteinSimplex& factor = *form.factors()[f];
        std::vector<double> values;
        for (auto first = left.begin(); first != left.end(); first += factor.size())
            values.push_back(evaluate(factor, {first, first + factor.size()}, l[f]));
        left = values;
    }
    return left.front();
}

TEST(BernsteinForm, BisectionKeepsThePolynomialAndCornersAreValues) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (const auto& [dimensions, degrees] : std::vector<std::pair<std::vector<int>, std::vector<int>>>{
             {{1, 1}, {3, 2}}, {{1, 1, 1}, {2, 3, 1}}, {{2, 1}, {4, 3}}, {{3}, {4}}}) {
        const BernsteinForm form(dimensions, degrees);
        std::vector<double> c(form.size()), near_a(form.size()), near_b(form.size());
        for (double& v : c) v = normal(random);
        for (const BernsteinForm::Corner& corner : form.corners()) {
            std::vector<std::array<double, 4>> point(dimensions.size());
            for (std::size_t f = 0; f < dimensions.size(); ++f) point[f][corner.of_factor[f]] = 1.0;
            EXPECT_EQ(evaluate(form, c, point), c[corner.position]);
        }
        for (std::size_t f = 0; f < dimensions.size(); ++f)
            for (int a = 0; a <= dimensions[f]; ++a)
                for (int b = 0; b <= dimensions[f]; ++b) {
                    if (a == b) continue;
                    form.bisect(static_cast<int>(f), a, b, c.data(), near_a.data(), near_b.data());
                    std::vector<std::array<double, 4>> half;
                    for (const int dim : dimensions) half.push_back(random_point(dim, random));
                    auto whole = half;
                    whole[f][a] += 0.5 * half[f][b];
                    whole[f][b] *= 0.5;
                    EXPECT_NEAR(evaluate(form, near_a, half), evaluate(form, c, whole), 1e-12);
                    whole = half;
                    whole[f][b] += 0.5 * half[f][a];
                    whole[f][a] *= 0.5;
                    EXPECT_NEAR(evaluate(form, near_b, half), evaluate(form, c, whole), 1e-12);
                }
    }
}

TEST(LagrangeToBernstein, BothFormsHaveTheSameValues) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const Shape shape : {Shape::line, Shape::triangle, Shape::tetrahedron})
        for (int order = 1; order <= max_order; ++order) {
            const ElementType type{shape, order};
            const int dim = dimension(shape);
            const auto& form = BernsteinSimplex::get(dim, order);
            Eigen::VectorXd nodal(form.size());
            for (auto& v : nodal) v = normal(random);
            const Eigen::VectorXd bezier = lagrange_to_bernstein(type).cast<double>() * nodal;
            const auto l = random_point(dim, random);
            const Eigen::RowVector3d point(l[1], l[2], l[3]);
            const double expected = lagrange_basis(type, point).values.row(0) * nodal;
            const double actual = evaluate(form, {bezier.begin(), bezier.end()}, l);
            EXPECT_NEAR(actual, expected, 1e-11 * std::max(1.0, bezier.cwiseAbs().maxCoeff())) << name(type);
        }
}

TEST(LagrangeToBernstein, RowsSumToOneToTheLastBit) {
    // Integer overflow in the products would show here first.
    for (const Shape shape : {Shape::line, Shape::triangle, Shape::tetrahedron})
        for (int order = 1; order <= max_order; ++order) {
            const ExtendedMatrix& matrix = lagrange_to_bernstein({shape, order});
            for (Eigen::Index row = 0; row < matrix.rows(); ++row)
                EXPECT_LT(std::abs(static_cast<double>(matrix.row(row).sum() - 1.0L)),
                          1e-16 * static_cast<double>(matrix.row(row).cwiseAbs().sum()));
        }
}

}  // namespace
}  // namespace curvewright
