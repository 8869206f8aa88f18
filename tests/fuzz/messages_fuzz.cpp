// Hostile LCM messages: every type is decoded from bytes that began as a valid message and were
// edited, cut or lengthened by the input. Whatever decodes must encode to the same bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "msgs/convert.hpp"
#include "tests/unit/msgs/samples.hpp"

namespace {

using hopscotch::msgs::Bytes;
namespace msgs = hopscotch::msgs;
namespace samples = hopscotch::msgs::samples;

/// Input: new length (2 bytes, 0: unchanged), then edits of place (3 bytes) and value.
Bytes edited(Bytes bytes, const std::uint8_t* data, std::size_t size) {
  if (size < 2) return bytes;
  const std::size_t length = data[0] + 256U * data[1];
  if (length > 0) bytes.resize(length);
  for (std::size_t i = 2; i + 4 <= size && !bytes.empty(); i += 4) {
    const std::size_t place = data[i] + 256U * data[i + 1] + 65536U * data[i + 2];
    bytes[place % bytes.size()] = data[i + 3];
  }
  return bytes;
}

template <typename Value>
void check(const Value& sample, const std::uint8_t* data, std::size_t size) {
  const Bytes bytes = edited(msgs::encode(sample, {1, 2}), data, size);
  const auto message = msgs::decode<Value>(bytes);
  if (!message) return;
  // Flags other than 0 and 1 mean true and come back as 1, so compare what a second round gives.
  const Bytes once = msgs::encode(message->value, message->tag);
  const auto again = msgs::decode<Value>(once);
  if (!again || msgs::encode(again->value, again->tag) != once) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::uint8_t* rest = data + 1;
  switch (data[0] % 17) {
    case 0: check(samples::sensors(), rest, size - 1); break;
    case 1: check(samples::state(), rest, size - 1); break;
    case 2: check(samples::command(), rest, size - 1); break;
    case 3: check(samples::plan(), rest, size - 1); break;
    case 4: check(samples::terrain(), rest, size - 1); break;
    case 5: check(samples::choice(), rest, size - 1); break;
    case 6:
      check(msgs::TargetCommand{{1}, hopscotch::core::TargetOverride{.distance = 0.3}}, rest,
            size - 1);
      break;
    case 7: check(msgs::ModeCommand{}, rest, size - 1); break;
    case 8:
      check(
          msgs::Ack{
              {1}, "HOP_TARGET_CMD", 3, false, {hopscotch::core::Reason::not_now, "why"}, 0.5},
          rest, size - 1);
      break;
    case 9: check(samples::status(), rest, size - 1); break;
    case 10: check(samples::truth(), rest, size - 1); break;
    case 11: check(samples::scene(), rest, size - 1); break;
    case 12: check(msgs::AnchorRecord{samples::state()}, rest, size - 1); break;
    case 13: check(msgs::TargetQuestion{.rest = samples::state()}, rest, size - 1); break;
    case 14: check(msgs::EstimatorPrior{}, rest, size - 1); break;
    case 15:
      check(msgs::DepthRecord{.frame = {.intrinsics = {2, 1, 1.0, 1.0, 1.0, 0.5},
                                        .depth = {1.0F, 0.0F}},
                              .at_exposure = samples::state()},
            rest, size - 1);
      break;
    default: check(msgs::MapView{}, rest, size - 1); break;
  }
  return 0;
}
