#include "engine/world/ObjectLookAccess.h"

#include <memory>

#include "engine/world/Object.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"

namespace df {

int ObjectLookAccess::setFrames(Object& object, const naiad::Sequence& frames,
                                const naiad::Selector& selector) {
  WorldStore& store = *object.m_p_store;
  if (frames.empty()) {
    store.setFrames(object.m_slot, nullptr);
    return 0;
  }
  const bool small = frames.size() <= naiad::kMaxFrames && frames.glyphCount() <= naiad::kMaxGlyphs &&
                     frames.reach() <= naiad::kMaxGlyphOffset;
  if (!small || !selector.fits(frames.size()) || naiad::encodedBits(frames) > 8 * naiad::kMaxLookBytes)
    return object.refuse("setFrames");
  store.setFrames(object.m_slot, std::make_shared<const naiad::Look>(naiad::Look{frames, 0, selector}));
  return 0;
}

int ObjectLookAccess::setSelector(Object& object, const naiad::Selector& selector) {
  WorldStore& store = *object.m_p_store;
  const std::shared_ptr<const naiad::Look>& p_look = store.frames(object.m_slot);
  if (p_look == nullptr || !selector.fits(p_look->sequence.size())) return object.refuse("setSelector");
  if (p_look->selector == selector) return 0;
  store.setFrames(object.m_slot,
                  std::make_shared<const naiad::Look>(naiad::Look{p_look->sequence, 0, selector}));
  return 0;
}

}  // namespace df
