// Positions that the client draws instead of the replica's: those predicted for its own object and the view
// that follows it, and those of other objects as limited by ExtrapolationClamp.
#pragma once

#include "client/world/ExtrapolationClamp.h"
#include "client/world/Prediction.h"
#include "shared/replica/Placement.h"

namespace naiad {

class DrawnPlacement : public Placement {
 public:
  /// The arguments must outlive this and must not change.
  DrawnPlacement(const Replica& replica, const Prediction& prediction, const ExtrapolationClamp& clamp)
      : m_replica(replica), m_prediction(prediction), m_clamp(clamp) {}

  /// `tick` must be the tick for which the clamp was made.
  df::FixedVector positionOf(const ObjectState& object, std::uint32_t /*tick*/) const override {
    return m_prediction.isOwn(object) ? m_prediction.position() : m_clamp.positionOf(object);
  }
  df::FixedVector viewCorner(df::FixedVector modelled) const override {
    const ObjectState* p_followed = m_replica.followed();
    const bool own = p_followed != nullptr && m_prediction.isOwn(*p_followed);
    return own ? m_prediction.viewCorner(m_replica) : modelled;
  }

 private:
  const Replica& m_replica;
  const Prediction& m_prediction;
  const ExtrapolationClamp& m_clamp;
};

}  // namespace naiad
