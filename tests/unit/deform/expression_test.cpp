#include "core/deform/expression.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

double value(const std::string& formula, double x = 2.0, double y = 3.0, double z = -1.5) {
    return CompiledExpression(formula).evaluate(x, y, z);
}

TEST(Expression, OperatorsAndFunctions) {
    EXPECT_DOUBLE_EQ(value("x + y * z"), 2.0 + 3.0 * -1.5);
    EXPECT_DOUBLE_EQ(value("-x^2"), -4.0);
    EXPECT_DOUBLE_EQ(value("2^3^2"), 512.0);
    EXPECT_DOUBLE_EQ(value("(x - y) / z"), -1.0 / -1.5);
    EXPECT_DOUBLE_EQ(value("sin(pi/2) + cos(0) + tan(0)"), 2.0);
    EXPECT_DOUBLE_EQ(value("sqrt(x*x + y*y)"), std::sqrt(13.0));
    EXPECT_DOUBLE_EQ(value("exp(log(y))"), 3.0);
    EXPECT_DOUBLE_EQ(value("log(exp(1))"), 1.0);
    EXPECT_DOUBLE_EQ(value("abs(z) + min(x, y, z) + max(x,y)"), 1.5 - 1.5 + 3.0);
    EXPECT_DOUBLE_EQ(value("1.5e-3"), 1.5e-3);
    EXPECT_DOUBLE_EQ(value("4*atan(1)"), std::numbers::pi);
    EXPECT_TRUE(std::isnan(value("sqrt(0-1)")));
    EXPECT_TRUE(std::isinf(value("1/(x-2)")));
}

TEST(Expression, IsEvaluatedAnewForEveryPoint) {
    CompiledExpression expression("x - 10*y + 100*z");
    EXPECT_DOUBLE_EQ(expression.evaluate(1, 2, 3), 281.0);
    EXPECT_DOUBLE_EQ(expression.evaluate(0, 0, 1), 100.0);
}

TEST(Expression, WrongFormulasAreNamed) {
    for (const char* formula : {"", "x +", "foo(x)", "w", "x y", "(x", "x)", "1..2", "sin()", "sin(x,y)", "x = 3",
                                "x, y", "_pi", "rnd(1)", "x ? y : z", "\"a\"", "x @ y", "min()"})
        try {
            CompiledExpression expression(formula);
            ADD_FAILURE() << "accepted: " << formula;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find("'" + std::string(formula) + "'"), std::string::npos)
                << error.what();
        }
}

}  // namespace
}  // namespace curvewright
