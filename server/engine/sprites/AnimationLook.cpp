#include "engine/sprites/AnimationLook.h"

#include <algorithm>

#include "engine/sprites/Sprite.h"

namespace df {

namespace {

naiad::Selector selectorOf(const Animation& animation, std::uint32_t tick) {
  const int slowdown = animation.getSprite()->getTicksPerFrame();
  const int count = animation.getSlowdownCount();
  const auto index = static_cast<std::size_t>(animation.getIndex());
  const bool still = slowdown < 1 || count < 0 || slowdown > int{naiad::kMaxTicksPerFrame};
  if (still) return naiad::Selector::fixed(index);
  // A count set beyond the slowdown turns the page with the next tick, as the last count before it does.
  const auto shown = static_cast<std::uint32_t>(std::min(count, slowdown - 1));
  return naiad::Selector::clock(tick - shown, static_cast<std::uint32_t>(slowdown), true, index);
}

}  // namespace

std::shared_ptr<const naiad::Look> lookOf(const Animation& animation, std::uint32_t tick,
                                          const std::shared_ptr<const naiad::Look>& before) {
  const Sprite* p_sprite = animation.getSprite();
  if (p_sprite == nullptr || p_sprite->getFrameCount() < 2) return nullptr;
  if (animation.getTransform() != Transform::NO_TRANSFORM) return nullptr;  // the pictures are others
  if (animation.getIndex() < 0 || animation.getIndex() >= p_sprite->getFrameCount()) return nullptr;
  const naiad::Sequence& pictures = SpritePictures::of(*p_sprite);
  if (pictures.empty()) return nullptr;
  const naiad::Selector selector = selectorOf(animation, tick).rebased(tick, pictures.size());
  if (before != nullptr && before->sequence.isSharedWith(pictures) &&
      before->selector.rebased(tick, pictures.size()) == selector)
    return before;
  return std::make_shared<const naiad::Look>(naiad::Look{pictures, 0, selector});
}

}  // namespace df
