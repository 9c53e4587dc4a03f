#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace curvewright {

/// Values of a sequence of unknown length: all of them as long as they are not too many, then every second, every
/// fourth, …, and always the last.
template <class Value>
class Thinned {
  public:
    /// limit: at least 2.
    explicit Thinned(std::size_t limit = 2048) : limit_(limit) {}

    void add(Value value) {
        const bool is_kept = count_ % stride_ == 0;
        ++count_;
        if (!is_kept) {
            last_ = std::move(value);
            return;
        }
        last_.reset();
        if (kept_.size() == limit_) {
            std::size_t next = 0;
            for (std::size_t i = 0; i < kept_.size(); i += 2) {
                if (next != i) kept_[next] = std::move(kept_[i]);
                ++next;
            }
            kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(next), kept_.end());
            stride_ *= 2;
            if ((count_ - 1) % stride_ != 0) {
                last_ = std::move(value);
                return;
            }
        }
        kept_.push_back(std::move(value));
    }
    std::vector<Value> values() const {
        std::vector<Value> result = kept_;
        if (last_) result.push_back(*last_);
        return result;
    }
    /// Of all that were added.
    std::size_t count() const { return count_; }

  private:
    std::size_t limit_, stride_ = 1, count_ = 0;
    std::vector<Value> kept_;
    std::optional<Value> last_;
};

}  // namespace curvewright
