#include "engine/world/Resources.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/sprites/SpriteFile.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldState.h"

namespace df {

namespace {

namespace fs = std::filesystem;

bool sameButForCase(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// Returns the entries of the folder whose names equal `name`, exactly or except for case.
std::vector<fs::path> matches(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (name == "." || name == "..") return {folder / name};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string called = entry.path().filename().string();
    if (sameButForCase(called, name)) found.push_back(folder / called);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Returns the first kMaxShown labels as a text "; loaded: saucer, ship", or "; loaded: none".
template <class Labels>
std::string loadedAre(const Labels& labels) {
  constexpr std::size_t kMaxShown = 12;
  std::string text;
  std::size_t count = 0;
  for (const std::string& label : labels) {
    if (++count > kMaxShown) return text + ", …";
    text += (text.empty() ? "; loaded: " : ", ") + label;
  }
  return text.empty() ? "; loaded: none" : text;
}

std::string nothingLoaded(const char* call, const std::string& label, const std::string& loaded) {
  return "RM." + std::string(call) + "(\"" + label + "\"): nothing is loaded under this label" + loaded;
}

int loadFile(Sound& sound, const std::string& filename) {
  return sound.loadSound(filename);
}

int loadFile(Music& music, const std::string& filename) {
  return music.loadMusic(filename);
}

bool isFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

}  // namespace

std::string findCaseInsensitive(const std::string& folder, const std::string& name) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::vector<fs::path> candidates = {folder};
  for (const fs::path& part : fs::path(slashed)) {
    std::vector<fs::path> next;
    for (const fs::path& candidate : candidates) {
      const std::vector<fs::path> found = matches(candidate, part.string());
      next.insert(next.end(), found.begin(), found.end());
    }
    candidates = std::move(next);
  }
  const auto file = std::find_if(candidates.begin(), candidates.end(), [](const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
  });
  return file == candidates.end() ? std::string() : file->string();
}

void Resources::clear() {
  for (auto& p_sprite : m_sprites) m_unloaded.push_back(std::move(p_sprite));
  m_sprites.clear();
  m_failed_sprites.clear();
  m_sounds.clear();
  m_musics.clear();
}

std::string Resources::locate(const std::string& filename) const {
  if (isFile(filename) || std::filesystem::path(filename).is_absolute()) return filename;
  for (const std::string& folder : m_folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / filename;
    if (isFile(path)) return path.string();
  }
  // Many games are written on Windows, where "Sprites\Ship.txt" finds sprites/ship.txt.
  std::string found = findCaseInsensitive("", filename);
  for (std::size_t i = 0; i < m_folders.size() && found.empty(); ++i)
    found = findCaseInsensitive(m_folders[i], filename);
  return found.empty() ? filename : found;
}

std::string Resources::searchedFolders(const std::string& filename) const {
  if (std::filesystem::path(filename).is_absolute()) return {};
  std::error_code error;
  std::string text = "; looked in " + std::filesystem::current_path(error).string();
  for (const std::string& folder : m_folders) text += ", " + folder;
  return text;
}

bool Resources::open(const std::string& filename) const {
  const std::string path = locate(filename);
  return isFile(path) && std::ifstream(path).good();
}

std::optional<std::string> Resources::read(const std::string& filename) const {
  const std::string path = locate(filename);
  if (!isFile(path)) return std::nullopt;  // tested first, because opening a pipe would wait for its writer
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int Resources::loadSprite(const std::string& filename, const std::string& label) {
  std::unique_ptr<Sprite> loaded = readSprite(filename, label);
  if (loaded == nullptr) {
    m_failed_sprites.insert(label);
    return -1;
  }
  m_failed_sprites.erase(label);
  if (sprite(label) == nullptr) m_sprites.push_back(std::move(loaded));
  return 0;
}

std::unique_ptr<Sprite> Resources::readSprite(const std::string& filename, const std::string& label) {
  const std::optional<std::string> text = read(filename);
  if (!text) {
    m_log.write("Sprite " + label + ": " + filename + ": cannot be read" + searchedFolders(filename));
    return nullptr;
  }
  std::string error;
  std::vector<std::string> oddities;
  std::unique_ptr<Sprite> loaded = parseSprite(*text, label, error, m_state.compat ? &oddities : nullptr);
  const std::string where = "Sprite " + label + ": " + filename + ":";
  for (const std::string& oddity : oddities) m_log.write(where + oddity + " (compat)");
  if (loaded == nullptr) m_log.write(where + error);
  return loaded;
}

int Resources::unloadSprite(const std::string& label) {
  const auto it = std::find_if(m_sprites.begin(), m_sprites.end(),
                               [&](const auto& p_sprite) { return p_sprite->getLabel() == label; });
  if (it == m_sprites.end()) return -1;
  m_unloaded.push_back(std::move(*it));
  m_sprites.erase(it);
  return 0;
}

Sprite* Resources::sprite(const std::string& label) const {
  for (const auto& p_sprite : m_sprites) {
    if (p_sprite->getLabel() == label) return p_sprite.get();
  }
  return nullptr;
}

std::string Resources::spriteLabels() const {
  std::vector<std::string> labels;
  for (const auto& p_sprite : m_sprites) labels.push_back(p_sprite->getLabel());
  return loadedAre(labels);
}

// Games ask for a sprite to learn whether they have to load it, so null is not an error. If a crash follows,
// its report has the line.
Sprite* Resources::spriteOrPlaceholder(const std::string& label) {
  Sprite* p_sprite = sprite(label);
  if (p_sprite != nullptr || m_state.compat) return p_sprite;
  if (m_failed_sprites.contains(label)) return &missingSprite();
  m_log.addActivityLineOnce(nothingLoaded("getSprite", label, spriteLabels()));
  return nullptr;
}

Sprite& Resources::missingSprite() {
  if (m_missing_sprite == nullptr) {
    m_missing_sprite = std::make_unique<Sprite>(1);
    m_missing_sprite->setLabel("missing");
    m_missing_sprite->setWidth(1);
    m_missing_sprite->setHeight(1);
    m_missing_sprite->addFrame(Frame(1, 1, "?"));
  }
  return *m_missing_sprite;
}

template <class T>
int SoundBank<T>::load(const std::string& filename, const std::string& label) {
  T* const p_before = find(label);
  if (p_before != nullptr && !p_before->isSilent()) return 0;
  T& loaded = p_before != nullptr ? *p_before : m_all.emplace_back();
  loaded.setLabel(label);
  loaded.silence(loadFile(loaded, filename) != 0);
  if (!loaded.isSilent()) return 0;
  if (p_before == nullptr && !m_state.compat) m_all.pop_back();
  return -1;
}

template <class T>
int SoundBank<T>::unload(const std::string& label) {
  T* p_sound = find(label);
  if (p_sound == nullptr) return -1;
  p_sound->endLoop();
  m_all.remove_if([p_sound](const T& one) { return &one == p_sound; });
  return 0;
}

template <class T>
T* SoundBank<T>::find(const std::string& label) {
  for (T& one : m_all) {
    if (one.getLabel() == label) return &one;
  }
  return nullptr;
}

template <class T>
T* SoundBank<T>::findOrPlaceholder(const std::string& label) {
  T* p_sound = find(label);
  // Games of the published engine test for null pointers.
  if (p_sound != nullptr || m_state.compat) return p_sound;
  std::vector<std::string> labels;
  for (const T& one : m_all) labels.push_back(one.getLabel());
  m_log.writeOnce(nothingLoaded(m_get, label, loadedAre(labels)));
  if (m_p_missing == nullptr) {
    m_p_missing = std::make_unique<T>();
    m_p_missing->silence();
  }
  return m_p_missing.get();
}

template class SoundBank<Sound>;
template class SoundBank<Music>;

}  // namespace df
