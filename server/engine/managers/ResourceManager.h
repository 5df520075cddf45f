// Loads sprites, sounds and music and keeps them by their labels (book, Listings 4.141 and 4.172).
//
// File names are relative to the working directory. What is wrong with a file goes to the log, with its name
// and the line. A label that is taken stays with what was loaded first.
#pragma once

#include <string>

#include "Manager.h"
#include "Music.h"
#include "Sound.h"
#include "Sprite.h"
#include "StandardHeaders.h"

/// The resource manager.
#define RM df::ResourceManager::getInstance()

namespace df {

/// Of the published engine, for games that name them: here there are no limits.
inline constexpr int MAX_SPRITES = 1000;
inline constexpr int MAX_SOUNDS = 50;
inline constexpr int MAX_MUSICS = 50;

class ResourceManager : public Manager {
 public:
  /// The one there is; RM is short for it. It acts on the current world.
  static ResourceManager& getInstance();

  /// Load a sprite in one of the three formats (SpriteFile.h). Return 0, else -1.
  int loadSprite(const std::string& filename, const std::string& label);
  /// Objects that have it go on showing it. Return 0, or -1 if there is none.
  int unloadSprite(const std::string& label);
  /// Null if none was loaded under this label, so that a game may ask; if its file could not be loaded, one
  /// that shows a '?' (compat: null).
  Sprite* getSprite(const std::string& label) const;

  /// Return 0, or -1 for a file that cannot be read.
  int loadSound(const std::string& filename, const std::string& label);
  /// Return 0, or -1 if there is none.
  int unloadSound(const std::string& label);
  /// If there is none: one that plays nothing, with a line in the log (compat: null).
  Sound* getSound(const std::string& label);

  /// Return 0, or -1 for a file that cannot be read.
  int loadMusic(const std::string& filename, const std::string& label);
  /// Return 0, or -1 if there is none.
  int unloadMusic(const std::string& label);
  /// If there is none: one that plays nothing, with a line in the log (compat: null).
  Music* getMusic(const std::string& label);

 private:
  ResourceManager();
};

}  // namespace df
