#include "Checksum.h"

namespace naiad {

namespace {

/// Mixes one number after the other (the finaliser of SplitMix64 between them).
class Mixer {
 public:
  Mixer(Group group, std::uint32_t id) {
    add(group);
    add(id);
  }
  void add(std::uint64_t value) {
    m_state += value + 0x9E3779B97F4A7C15;
    m_state = (m_state ^ (m_state >> 30)) * 0xBF58476D1CE4E5B9;
    m_state = (m_state ^ (m_state >> 27)) * 0x94D049BB133111EB;
    m_state ^= m_state >> 31;
  }
  void add(df::FixedVector v) {
    add(static_cast<std::uint64_t>(v.x));
    add(static_cast<std::uint64_t>(v.y));
  }
  std::uint64_t value() const { return m_state; }

 private:
  std::uint64_t m_state = 0;
};

}  // namespace

std::uint64_t lifeSum(std::uint32_t id, std::uint8_t generation, std::uint64_t order) {
  Mixer mixer(kLife, id);
  mixer.add(generation);
  mixer.add(order);
  return mixer.value();
}

std::uint64_t motionSum(std::uint32_t id, const Motion& motion) {
  Mixer mixer(kMotion, id);
  const Motion at_zero = rebase(motion, 0);
  mixer.add(at_zero.position);
  mixer.add(at_zero.velocity);
  mixer.add(at_zero.acceleration);
  return mixer.value();
}

std::uint64_t lookSum(std::uint32_t id, const Look& look) {
  Mixer mixer(kLook, id);
  mixer.add(static_cast<std::uint64_t>(look.altitude));
  for (const Appearance& appearance : look.sequence) {
    mixer.add(appearance.size());
    for (const Glyph& glyph : appearance) {
      mixer.add((static_cast<std::uint64_t>(static_cast<std::uint32_t>(glyph.dx)) << 32) |
                static_cast<std::uint32_t>(glyph.dy));
      mixer.add((static_cast<std::uint64_t>(glyph.ch) << 8) | static_cast<std::uint64_t>(glyph.color));
    }
  }
  return mixer.value();
}

std::uint64_t bodySum(std::uint32_t id, const Body& body) {
  Mixer mixer(kBody, id);
  mixer.add(body.box.corner);
  mixer.add(body.box.size);
  mixer.add(static_cast<std::uint64_t>(body.solidness) * 2 + (body.no_soft ? 1 : 0));
  return mixer.value();
}

}  // namespace naiad
