#pragma once

#include <memory>
#include <string>

namespace curvewright {

/// A formula in x, y, z and pi with + - * / ^, parentheses, sin cos tan asin acos atan sqrt exp log (natural) abs min
/// max.
class CompiledExpression {
  public:
    /// Throws InvalidInput with the formula, the position of the fault and what was expected.
    explicit CompiledExpression(const std::string& formula);
    ~CompiledExpression();
    CompiledExpression(CompiledExpression&&) noexcept;

    /// Value at a point; may be infinite or NaN.
    double evaluate(double x, double y, double z);

  private:
    struct Parser;
    std::unique_ptr<Parser> parser_;
};

}  // namespace curvewright
