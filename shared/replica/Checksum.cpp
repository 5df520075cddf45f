#include "shared/replica/Checksum.h"

#include "shared/replica/LookCodec.h"
#include "shared/replica/Mixer.h"

namespace naiad {

namespace {

Mixer mixerOf(Group group, std::uint32_t id) {
  Mixer mixer;
  mixer.add(group);
  mixer.add(id);
  return mixer;
}

/// Adds the selector's kind and the fields that this kind uses, in a form that is equal at any tick.
void addTo(Mixer& mixer, const Selector& selector, std::size_t frames) {
  mixer.add(selector.kind);
  switch (selector.kind) {
    case Selector::kFixed:
      return mixer.add(selector.frame);
    case Selector::kClock:
      mixer.add(selector.ticks_per_frame);
      return mixer.add(selector.age(0, frames));
    case Selector::kClockOnce:
      mixer.add(selector.ticks_per_frame);
      return mixer.add(selector.start);
    case Selector::kAngle:
      mixer.add(selector.angle);
      return mixer.add(static_cast<std::uint32_t>(selector.spin));
  }
}

}  // namespace

std::uint64_t lifeSum(std::uint32_t id, std::uint8_t generation, std::uint64_t order) {
  Mixer mixer = mixerOf(kLife, id);
  mixer.add(generation);
  mixer.add(order);
  return mixer.value();
}

std::uint64_t motionSum(std::uint32_t id, const Motion& motion) {
  Mixer mixer = mixerOf(kMotion, id);
  const Motion at_zero = rebase(motion, 0);
  mixer.add(at_zero.position);
  mixer.add(at_zero.velocity);
  mixer.add(at_zero.acceleration);
  return mixer.value();
}

std::uint64_t lookSum(std::uint32_t id, const Look& look) {
  Mixer mixer = mixerOf(kLook, id);
  mixer.add(static_cast<std::uint64_t>(look.altitude));
  if (!look.sequence.empty()) {
    mixer.add(look.sequence.sum());
    addTo(mixer, look.selector, look.sequence.size());
  }
  return mixer.value();
}

std::uint64_t bodySum(std::uint32_t id, const Body& body) {
  Mixer mixer = mixerOf(kBody, id);
  mixer.add(body.box.corner);
  mixer.add(body.box.size);
  mixer.add(wireSolidness(body) * 2 + (body.no_soft ? 1 : 0));
  return mixer.value();
}

}  // namespace naiad
