#include "host/journal/DeterminismCheck.h"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

namespace naiad {

namespace {

std::string placeText(df::FixedVector place) {
  const auto cells = [](df::Fixed value) {
    return static_cast<double>(value) / static_cast<double>(df::kFixedOne);
  };
  char text[80];
  std::snprintf(text, sizeof text, "(%.2f, %.2f)", cells(place.x), cells(place.y));
  return text;
}

std::string describe(const df::ObjectFacts& first, const df::ObjectFacts& again) {
  const std::string which = "Object " + std::to_string(first.order);
  if (first.position != again.position)
    return which + " is at " + placeText(again.position) + ", not at " + placeText(first.position);
  if (first.velocity != again.velocity)
    return which + " moves by " + placeText(again.velocity) + ", not by " + placeText(first.velocity);
  return {};
}

bool isSame(const df::DrawCommand& a, const df::DrawCommand& b) {
  return a.position == b.position && a.ch == b.ch && a.color == b.color;
}

}  // namespace

std::string describeDifference(const df::WorldView& first, const df::WorldView& again) {
  const std::size_t common = std::min(first.changed.size(), again.changed.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (first.changed[i].order != again.changed[i].order)
      return "Object " + std::to_string(std::min(first.changed[i].order, again.changed[i].order)) +
             " changes in only one of the two runs";
    if (std::string text = describe(first.changed[i], again.changed[i]); !text.empty()) return text;
  }
  if (first.changed.size() != again.changed.size()) return "different Objects change";
  for (std::size_t i = 0; i < std::min(first.players.size(), again.players.size()); ++i) {
    if (first.players[i].score != again.players[i].score)
      return "different score of player " + std::to_string(first.players[i].id);
  }
  const bool drawn_same = std::equal(first.commands.begin(), first.commands.end(), again.commands.begin(),
                                     again.commands.end(), isSame);
  return drawn_same ? std::string() : "different characters are drawn";
}

DeterminismCheck::DeterminismCheck(NewWorld new_world, std::function<void(const std::string&)> on_difference)
    : m_new_world(std::move(new_world)), m_on_difference(std::move(on_difference)) {}

DeterminismCheck::~DeterminismCheck() = default;

void DeterminismCheck::add(const SentTurn& turn, std::uint64_t answer_hash, const df::WorldView& view) {
  if (m_over || m_added >= kTicks) return;
  ++m_added;
  m_waiting.push_back({turn, answer_hash, turn.turn.watched ? view : df::WorldView()});
}

bool DeterminismCheck::update() {
  if (m_over) return false;
  if (m_world == nullptr) {
    if (m_added >= kDelay) start();
    return !m_over;
  }
  m_world->checkProcess(1);
  if (m_world->end()) m_over = true;  // even after a crash, which is not this check's concern
  m_allowed = kTurnsPerTick;
  sendNext();
  return !m_over;
}

void DeterminismCheck::start() {
  try {
    m_world = m_new_world();
  } catch (const std::system_error&) {
    m_over = true;
    return;
  }
  m_world->setOnTick([this] {
    compare();
    sendNext();
  });
}

void DeterminismCheck::sendNext() {
  if (m_over || m_allowed <= 0 || m_waiting.empty() || !m_world->isReady()) return;
  --m_allowed;
  m_world->tick(m_waiting.front().sent);
}

void DeterminismCheck::compare() {
  const Tick tick = std::move(m_waiting.front());
  m_waiting.pop_front();
  ++m_compared;
  m_over = m_compared >= kTicks || m_world->answer().game_over;
  if (m_world->answer().hash == tick.answer_hash) return;
  m_over = true;
  std::string what = tick.sent.turn.watched ? describeDifference(tick.view, m_world->view()) : std::string();
  if (what.empty()) what = "the result is different";
  m_on_difference("the game is not repeatable: when replayed, in tick " + std::to_string(m_compared) + " " +
                  what);
}

}  // namespace naiad
