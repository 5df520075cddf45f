// The complete Saucer Shoot of the Dragonfly book's tutorial, written as for the published engine: a single
// implied player, sprites from files, sounds, a title and an end.
#include "GameManager.h"
#include "GameStart.h"
#include "LogManager.h"
#include "Pause.h"
#include "ResourceManager.h"
#include "Star.h"
#include "utility.h"

void loadResources(void) {
  RM.loadSprite("sprites/saucer-spr.txt", "saucer");
  RM.loadSprite("sprites/ship-spr.txt", "ship");
  RM.loadSprite("sprites/bullet-spr.txt", "bullet");
  RM.loadSprite("sprites/explosion-spr.txt", "explosion");
  RM.loadSprite("sprites/gamestart-spr.txt", "gamestart");
  RM.loadSprite("sprites/gameover-spr.txt", "gameover");
  RM.loadSound("sounds/fire.wav", "fire");
  RM.loadSound("sounds/explode.wav", "explode");
  RM.loadMusic("sounds/start-music.wav", "start music");
}

void populateWorld(void) {
  for (int i = 0; i < 16; i++) new Star;
  new GameStart;
}

int main(int argc, char* argv[]) {
  (void)argc;
  (void)argv;
  if (GM.startUp()) {
    LM.writeLog("Error starting game manager!");
    GM.shutDown();
    return 1;
  }
  LM.setFlush(true);
  df::splash();
  loadResources();
  populateWorld();
  new df::Pause(df::Keyboard::F10);
  GM.run();
  GM.shutDown();
  return 0;
}
