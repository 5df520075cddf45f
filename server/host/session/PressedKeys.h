// The keys that a player holds down, by the inputs received. A client that is cut off or killed sends no
// releases, so the server makes them.
#pragma once

#include <bitset>
#include <cstddef>

#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

class PressedKeys {
 public:
  void noteInput(const Input& input) {
    if (!input.is_mouse) m_down.set(input.key, input.action != df::KEY_RELEASED);
  }
  /// Call `release(input)` with a release of each key that is down, by key. No key is down afterwards.
  template <class Release>
  void releaseAll(Release release) {
    for (std::size_t key = 0; key < m_down.size() && m_down.any(); ++key) {
      if (!m_down.test(key)) continue;
      m_down.reset(key);
      Input input;
      input.key = static_cast<std::uint8_t>(key);
      input.action = df::KEY_RELEASED;
      release(input);
    }
  }

 private:
  std::bitset<df::Keyboard::kKeyCount> m_down;
};

}  // namespace naiad
