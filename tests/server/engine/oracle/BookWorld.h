// Fixture with an oracle world that records all received events in one line of text.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "Oracle.h"

namespace oracle {

inline FixedVector cells(double x, double y) {
  return {*df::toFixed(x), *df::toFixed(y)};
}

/// Returns a box of this many cells, centred on the position.
inline FixedBox boxOf(double width, double height) {
  return {cells(-width / 2, -height / 2), cells(width, height)};
}

class BookWorld : public testing::Test, protected Handlers {
 protected:
  Object* make(double x, double y, Solidness solidness = df::HARD) {
    Object* p_o = m_world.create(m_next++);
    p_o->position = cells(x, y);
    p_o->solidness = solidness;
    return p_o;
  }

  void step(Object*) override {}
  void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) override {
    m_events += std::to_string(p_receiver->id) + ":" + std::to_string(p_obj1->id) + ">" +
                std::to_string(p_obj2->id) + " ";
    m_where = where;
    if (m_on_collision) m_on_collision(p_receiver);
  }
  void out(Object* p_receiver) override { m_events += "out:" + std::to_string(p_receiver->id) + " "; }
  void destroyed(Object* p_o) override { m_events += "gone:" + std::to_string(p_o->id) + " "; }

  World m_world{FixedBox{{}, cells(80, 24)}, *this};
  std::string m_events;  ///< "receiver:mover>other "
  FixedVector m_where;   ///< position of the last collision
  std::function<void(Object*)> m_on_collision;
  int m_next = 0;
};

}  // namespace oracle
