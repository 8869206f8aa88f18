#pragma once

#include <utility>
#include <variant>

#include "core/check.hpp"
#include "core/reason.hpp"

namespace hopscotch::core {

/// A value, or the reason why there is none: the part of `std::expected` that this project needs.
/// Used per jump and per frame; start-up errors throw, the control tick returns status enums.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}            // NOLINT(google-explicit-constructor)
  Result(Refusal refusal) : content_(std::move(refusal)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  const T& value() const {
    HOPSCOTCH_CHECK(has_value());
    return std::get<0>(content_);
  }
  T& value() {
    HOPSCOTCH_CHECK(has_value());
    return std::get<0>(content_);
  }
  const T& operator*() const { return value(); }
  const T* operator->() const { return &value(); }
  const Refusal& error() const {
    HOPSCOTCH_CHECK(!has_value());
    return std::get<1>(content_);
  }

 private:
  std::variant<T, Refusal> content_;
};

}  // namespace hopscotch::core
