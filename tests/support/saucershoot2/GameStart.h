// The title screen: P plays, Q quits.
#pragma once

#include "Music.h"
#include "ViewObject.h"

class GameStart : public df::ViewObject {
 public:
  GameStart();
  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  void start();
  void playMusic();

  df::Music* p_music;
};
