#include <algorithm>

#include "hopscotch_msgs/map_view.hpp"
#include "msgs/convert.hpp"
#include "msgs/wire.hpp"

namespace hopscotch::msgs {

static_assert(hopscotch_msgs::map_view::MAX_CELLS == MapView::kMaxCells);

Bytes encode(const MapView& value, const Tag& tag) {
  hopscotch_msgs::map_view message{};
  wire::set_header(value.stamp, tag, message);
  message.origin_x = value.origin_x;
  message.origin_y = value.origin_y;
  message.resolution = value.resolution;
  message.size_x = value.size_x;
  message.size_y = value.size_y;
  std::copy(value.height_mm.begin(), value.height_mm.end(), message.height_mm);
  std::transform(value.state.begin(), value.state.end(), message.state,
                 [](core::CellState state) { return wire::number_of(state); });
  return wire::to_bytes(message);
}

template <>
std::optional<Tagged<MapView>> decode(std::span<const std::uint8_t> bytes) {
  const auto message = wire::from_bytes<hopscotch_msgs::map_view>(bytes);
  if (!message) return std::nullopt;
  const auto fits = [](std::int32_t size) { return size >= 0 && size <= MapView::kMaxSide; };
  if (!fits(message->size_x) || !fits(message->size_y)) return std::nullopt;
  Tagged<MapView> result{wire::tag_of(*message), {}};
  MapView& value = result.value;
  value.stamp = wire::stamp_of(*message);
  value.origin_x = message->origin_x;
  value.origin_y = message->origin_y;
  value.resolution = message->resolution;
  value.size_x = message->size_x;
  value.size_y = message->size_y;
  std::copy_n(message->height_mm, value.height_mm.size(), value.height_mm.begin());
  for (std::size_t i = 0; i < value.state.size(); ++i) {
    if (!wire::get_enum(message->state[i], core::CellState::observed, value.state[i])) {
      return std::nullopt;
    }
  }
  return result;
}

}  // namespace hopscotch::msgs
