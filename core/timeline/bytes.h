#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace curvewright {

/// Plain values one after the other, without padding, for stores of this process: in its own byte order.
class ByteWriter {
  public:
    template <class Value>
    void put(const Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(Value));
        std::memcpy(bytes_.data() + at, &value, sizeof(Value));
    }
    template <class Value>
    void put_all(std::span<const Value> values) {
        static_assert(std::is_trivially_copyable_v<Value>);
        if (values.empty()) return;
        const std::size_t at = bytes_.size();
        bytes_.resize(at + values.size_bytes());
        std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
    }
    std::span<const std::byte> bytes() const { return bytes_; }
    void clear() { bytes_.clear(); }

  private:
    std::vector<std::byte> bytes_;
};

/// Takes values out again. pre: as many as were put in.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <class Value>
    Value take() {
        Value value;
        std::memcpy(&value, rest_.data(), sizeof(Value));
        rest_ = rest_.subspan(sizeof(Value));
        return value;
    }
    template <class Value>
    void take_all(std::span<Value> values) {
        if (values.empty()) return;
        std::memcpy(values.data(), rest_.data(), values.size_bytes());
        rest_ = rest_.subspan(values.size_bytes());
    }

  private:
    std::span<const std::byte> rest_;
};

}  // namespace curvewright
