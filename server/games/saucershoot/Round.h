// The course of the game: the title, then all players fly until all ships are lost, then the title again.
// Players who join during a round get ships at once.
#pragma once

#include "EventPlayer.h"
#include "Events.h"
#include "Object.h"

class Round : public df::Object {
 public:
  Round();
  int eventHandler(const df::Event* p_e) override;

 private:
  void enter(EventRound::Part part);
  void step();

  EventRound::Part m_part = EventRound::TITLE;
};
