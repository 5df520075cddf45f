// Loads sprites, sounds and music and keeps them by their labels (book, Listings 4.141 and 4.172).
//
// File names are relative to the working directory. An error in a file is logged with the file's name and the
// line. A label in use keeps what was loaded first.
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

/// Limits of the published engine, for games that name them. Here the numbers are not limited.
inline constexpr int MAX_SPRITES = 1000;
inline constexpr int MAX_SOUNDS = 50;
inline constexpr int MAX_MUSICS = 50;

class ResourceManager : public Manager {
 public:
  /// Returns the only instance; RM is short for it. It acts on the current world.
  static ResourceManager& getInstance();

  /// Loads a sprite in one of the three formats (SpriteFile.h). Returns 0, else -1.
  int loadSprite(const std::string& filename, const std::string& label);
  /// Forgets a sprite; Objects that show it keep it. Returns 0, or -1 for an unknown label.
  int unloadSprite(const std::string& label);
  /// Returns the sprite. Null if none was loaded under this label, so that a game may ask. If its file could
  /// not be loaded, one that shows a '?' (compat: null).
  Sprite* getSprite(const std::string& label) const;

  /// Loads a sound. Returns 0, or -1 for a file that cannot be read.
  int loadSound(const std::string& filename, const std::string& label);
  /// Unloads a sound. Returns 0, or -1 for an unknown label.
  int unloadSound(const std::string& label);
  /// Returns the sound. For an unknown label, one that plays nothing, and logs a line (compat: null).
  Sound* getSound(const std::string& label);

  /// Loads a piece of music. Returns 0, or -1 for a file that cannot be read.
  int loadMusic(const std::string& filename, const std::string& label);
  /// Unloads a piece of music. Returns 0, or -1 for an unknown label.
  int unloadMusic(const std::string& label);
  /// Returns the music. For an unknown label, one that plays nothing, and logs a line (compat: null).
  Music* getMusic(const std::string& label);

 private:
  ResourceManager();
};

}  // namespace df
