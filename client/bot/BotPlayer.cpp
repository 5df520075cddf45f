#include "client/bot/BotPlayer.h"

#include <algorithm>
#include <array>

namespace naiad {

using namespace df::Keyboard;

std::vector<BotAction> ScriptPlayer::tick() {
  std::vector<BotAction> out;
  if (m_left > 0) {
    --m_left;
    if (m_left > 0) {
      if (m_down != UNDEFINED_KEY) out.push_back(KeyAction{m_down, df::KEY_DOWN});
      return out;
    }
  }
  if (m_down != UNDEFINED_KEY) {
    out.push_back(KeyAction{m_down, df::KEY_RELEASED});
    m_down = UNDEFINED_KEY;
  }
  skipLoops();
  if (m_at >= m_script.steps().size()) return out;
  const BotStep& step = m_script.steps()[m_at++];
  m_left = 1;
  switch (step.kind) {
    case BotStep::Kind::kPress:
    case BotStep::Kind::kHold:
      m_down = step.key;
      m_left = step.kind == BotStep::Kind::kHold ? step.count : 1;
      out.push_back(KeyAction{step.key, df::KEY_PRESSED});
      break;
    case BotStep::Kind::kWait:
      m_left = step.count;
      break;
    case BotStep::Kind::kClick:
      out.push_back(BotClick{df::CLICKED, step.button, step.x, step.y});
      break;
    case BotStep::Kind::kMove:
      out.push_back(BotClick{df::MOVED, df::Mouse::UNDEFINED_MOUSE_BUTTON, step.x, step.y});
      break;
    case BotStep::Kind::kChat:
      out.push_back(BotChat{step.text});
      break;
    default:
      break;
  }
  return out;
}

/// To the next step that takes time. Ends, because every loop and every script contains one.
void ScriptPlayer::skipLoops() {
  const auto& steps = m_script.steps();
  while (m_at < steps.size()) {
    const BotStep& step = steps[m_at];
    if (step.kind == BotStep::Kind::kLoop) {
      m_rounds.push_back(step.count);
      ++m_at;
    } else if (step.kind == BotStep::Kind::kEndLoop) {
      if (--m_rounds.back() > 0) {
        m_at = step.target + 1;
      } else {
        m_rounds.pop_back();
        ++m_at;
      }
    } else if (step.kind == BotStep::Kind::kRestart) {
      m_at = 0;
    } else {
      return;
    }
  }
}

RandomPlayer::RandomPlayer(std::uint64_t seed, int view_width, int view_height)
    : m_random(seed), m_width(std::max(view_width, 1)), m_height(std::max(view_height, 1)) {}

// Not std::uniform_int_distribution: its results differ between standard libraries.
int RandomPlayer::below(int limit) {
  return static_cast<int>(m_random() % static_cast<std::uint64_t>(limit));
}

std::vector<BotAction> RandomPlayer::tick() {
  static constexpr std::array<Key, 12> kKeys = {SPACE, SPACE, LEFTARROW, RIGHTARROW, UPARROW, DOWNARROW,
                                                W,     A,     S,         D,          RETURN,  SPACE};
  std::vector<BotAction> out;
  if (m_left-- > 0) {
    if (m_down != UNDEFINED_KEY) out.push_back(KeyAction{m_down, df::KEY_DOWN});
    return out;
  }
  if (m_down != UNDEFINED_KEY) {
    out.push_back(KeyAction{m_down, df::KEY_RELEASED});
    m_down = UNDEFINED_KEY;
  }
  m_left = 1 + below(12);
  const int choice = below(10);
  if (choice < 6) {
    m_down = kKeys[static_cast<std::size_t>(below(static_cast<int>(kKeys.size())))];
    out.push_back(KeyAction{m_down, df::KEY_PRESSED});
  } else if (choice < 9) {
    out.push_back(BotClick{df::CLICKED, df::Mouse::LEFT, below(m_width), below(m_height)});
  }
  return out;
}

}  // namespace naiad
