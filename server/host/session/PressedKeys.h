// The keys that a player holds down, as far as the server has heard: who is cut off, or whose client is
// killed, lets them go.
#pragma once

#include <bitset>
#include <cstddef>

#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

class PressedKeys {
 public:
  /// The player did this.
  void note(const Input& input) {
    if (!input.is_mouse) m_down.set(input.key, input.action != df::KEY_RELEASED);
  }
  /// Call `release(input)` for each key that is down, in their order, with an input that lets it go; then
  /// none is.
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
