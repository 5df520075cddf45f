// Random valid control tables and control states.
#pragma once

#include "shared/replica/ControlCodec.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

/// Returns a number in ±most, often a small or whole one.
inline df::Fixed randomFixed(SplitMix64& rng, df::Fixed most) {
  const df::Fixed far = rng.below(3) == 0 ? most : std::min(most, df::fromCells(3));
  const auto span = static_cast<std::uint64_t>(far);
  const auto value = static_cast<df::Fixed>(rng.below(2 * span + 1) - span);
  return rng.below(2) == 0 ? value : value & ~(df::kFixedOne - 1);
}

inline df::ControlRow randomRow(SplitMix64& rng) {
  df::ControlRow row;
  row.key = static_cast<df::Keyboard::Key>(rng.below(df::Keyboard::kKeyCount));
  row.effect = static_cast<df::ControlEffect>(rng.below(3));
  if (row.effect != df::ControlEffect::kDrive) {
    row.action = static_cast<df::EventKeyboardAction>(rng.below(3));
    row.wait = static_cast<std::uint16_t>(rng.below(3) == 0 ? rng.below(df::kMaxControlTicks + 1) : 0);
    row.group = static_cast<std::uint8_t>(rng.below(df::kControlGroups));
  }
  if (row.effect != df::ControlEffect::kStep) {
    row.x = rng.below(2) == 0;
    row.y = rng.below(2) == 0;
  }
  if (row.x) row.value.x = randomFixed(rng, df::kMaxControlReach);
  if (row.y) row.value.y = randomFixed(rng, df::kMaxControlReach);
  return row;
}

inline df::ControlTable randomTable(SplitMix64& rng) {
  df::ControlTable table;
  table.rows.resize(rng.below(df::kMaxControlRows + 1));
  for (df::ControlRow& row : table.rows) row = randomRow(rng);
  table.bounded = rng.below(2) == 0;
  if (table.bounded) {
    constexpr df::Fixed kFar = df::fromCells(1'000'000);
    table.bounds.corner = {randomFixed(rng, kFar), randomFixed(rng, kFar)};
    table.bounds.size = {std::abs(randomFixed(rng, kFar)), std::abs(randomFixed(rng, kFar))};
  }
  table.whole_cells = rng.below(2) == 0;
  table.patience = static_cast<std::uint16_t>(rng.below(2) == 0 ? 0 : rng.below(df::kMaxControlTicks + 1));
  return table;
}

inline ControlRecord randomControlRecord(SplitMix64& rng, std::uint32_t tick) {
  ControlRecord record;
  record.tick = tick;
  record.slot = static_cast<std::uint32_t>(rng.below(1u << 20));
  record.generation = static_cast<std::uint32_t>(rng.next() >> (32 + rng.below(32)));
  record.newest_input = static_cast<std::uint32_t>(rng.next() >> (32 + rng.below(32)));
  constexpr df::Fixed kPosition = df::fromCells(2'000'000'000);
  constexpr df::Fixed kVelocity = df::fromCells(1 << 24);
  record.position = {randomFixed(rng, kPosition), randomFixed(rng, kPosition)};
  record.velocity = {randomFixed(rng, kVelocity), randomFixed(rng, kVelocity)};
  record.acceleration = {randomFixed(rng, kVelocity), randomFixed(rng, kVelocity)};
  record.state.steering = rng.below(2) == 0;
  record.state.x = {randomFixed(rng, df::kMaxControlReach), rng.below(2) == 0};
  record.state.y = {randomFixed(rng, df::kMaxControlReach), rng.below(2) == 0};
  record.state.silence = static_cast<std::uint16_t>(rng.below(df::kMaxControlTicks + 1));
  for (std::uint16_t& wait : record.state.wait)
    wait = static_cast<std::uint16_t>(rng.below(2) == 0 ? 0 : rng.below(df::kMaxControlTicks + 1));
  return record;
}

}  // namespace naiad::test
