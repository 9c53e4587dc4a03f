#include "core/deform/expression.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <muParser.h>

#include "core/base/error.h"

namespace curvewright {
namespace {

double minimum(const double* values, int count) {
    return *std::min_element(values, values + count);
}
double maximum(const double* values, int count) {
    return *std::max_element(values, values + count);
}

}  // namespace

struct CompiledExpression::Parser {
    mu::Parser parser;
    double x = 0.0, y = 0.0, z = 0.0;
};

CompiledExpression::CompiledExpression(const std::string& formula) : parser_(std::make_unique<Parser>()) {
    mu::Parser& parser = parser_->parser;
    // Only what the file format promises: the library's own names (rnd, _e, sum, ?:, …) would become part of it.
    parser.ClearFun();
    parser.ClearConst();
    parser.ClearInfixOprt();
    parser.DefineInfixOprt("-", [](double v) { return -v; });
    parser.DefineInfixOprt("+", [](double v) { return v; });
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &parser_->x);
    parser.DefineVar("y", &parser_->y);
    parser.DefineVar("z", &parser_->z);
    parser.DefineFun("sin", [](double v) { return std::sin(v); });
    parser.DefineFun("cos", [](double v) { return std::cos(v); });
    parser.DefineFun("tan", [](double v) { return std::tan(v); });
    parser.DefineFun("asin", [](double v) { return std::asin(v); });
    parser.DefineFun("acos", [](double v) { return std::acos(v); });
    parser.DefineFun("atan", [](double v) { return std::atan(v); });
    parser.DefineFun("sqrt", [](double v) { return std::sqrt(v); });
    parser.DefineFun("exp", [](double v) { return std::exp(v); });
    parser.DefineFun("log", [](double v) { return std::log(v); });
    parser.DefineFun("abs", [](double v) { return std::abs(v); });
    parser.DefineFun("min", &minimum);
    parser.DefineFun("max", &maximum);
    // The library also knows assignments, comparisons and ?:, which the file format does not.
    const auto stranger =
        formula.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-*/^(), \t\r\n");
    try {
        if (stranger != std::string::npos)
            throw mu::Parser::exception_type(
                fmt::format("unexpected character '{}' at position {}", formula[stranger], stranger + 1));
        parser.SetExpr(formula);
        if (parser.Eval(), parser.GetNumResults() != 1)
            throw InvalidInput(
                fmt::format("the expression '{}' has {} values; one is expected", formula, parser.GetNumResults()));
    } catch (const mu::Parser::exception_type& error) {
        std::string message = error.GetMsg();
        while (!message.empty() && (message.back() == '.' || message.back() == '\n')) message.pop_back();
        throw InvalidInput(
            fmt::format("the expression '{}' is wrong ({}); it may use x, y, z, pi, + - * / ^, parentheses and the "
                        "functions sin cos "
                        "tan asin acos atan sqrt exp log abs min max",
                        formula, message));
    }
}

CompiledExpression::~CompiledExpression() = default;
CompiledExpression::CompiledExpression(CompiledExpression&&) noexcept = default;

double CompiledExpression::evaluate(double x, double y, double z) {
    parser_->x = x;
    parser_->y = y;
    parser_->z = z;
    return parser_->parser.Eval();
}

}  // namespace curvewright
