// The part of Object that writes and reads its attributes as text.

#include <charconv>
#include <optional>
#include <sstream>

#include "engine/world/ConfigText.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

constexpr unsigned kAll = (1u << ObjectAttributeMax) - 1;
// What serialize() calls the attributes, by the number of their bits.
constexpr const char* kNames[ObjectAttributeMax] = {
    "id",        "active",       "visible",  "events",    "box",         "pos",
    "type",      "animation",    "altitude", "solidness", "no_soft",     "speed",
    "direction", "acceleration", "shape",    "path",      "follow_path", "avoid_collisions"};

std::string number(double value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc() ? std::string(buffer, end) : "0";
}

std::string pair(const std::string& key, const std::string& value) {
  return key + ":" + value + ",";
}

std::string pair(const std::string& key, double value) {
  return pair(key, number(value));
}

std::string pair(const std::string& key, Vector v) {
  return pair(key + "-x", v.x()) + pair(key + "-y", v.y());
}

std::optional<double> numberOf(const std::string& text, const std::string& key) {
  const std::string value = valueOf(text, key);
  double result = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), result);
  if (value.empty() || error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  return result;
}

std::optional<Vector> vectorOf(const std::string& text, const std::string& key) {
  const auto x = numberOf(text, key + "-x");
  const auto y = numberOf(text, key + "-y");
  if (!x || !y) return std::nullopt;
  return Vector(*x, *y);
}

unsigned maskOf(const std::string& attr) {
  unsigned mask = 0;
  std::istringstream names(attr);
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "ALL") mask = kAll;
    for (int i = 0; i < ObjectAttributeMax; ++i) {
      if (name == kNames[i]) mask |= 1u << i;
    }
  }
  return mask;
}

}  // namespace

ObjectAttributes Object::attributes() const {
  const Box box = getBox();
  const Animation animation = getAnimation();
  const auto flag = [this](WorldStore::Flag f) { return m_p_store->has(m_slot, f) ? 1.0 : 0.0; };
  return {
      pair("id", getId()),
      pair("active", flag(WorldStore::kActive)),
      pair("visible", flag(WorldStore::kVisible)),
      pair("events", static_cast<double>(m_p_profile->interests.size())),
      pair("box", box.getCorner()) + pair("box-horizontal", box.width()) + pair("box-vertical", box.height()),
      pair("pos", getPosition()),
      pair("type", getType()),
      pair("animation", animation.getName()) + pair("animation-index", animation.getIndex()) +
          pair("animation-count", animation.getSlowdownCount()),
      pair("altitude", getAltitude()),
      pair("solidness", getSolidness()),
      pair("no_soft", flag(WorldStore::kNoSoft)),
      pair("velocity", getVelocity()),
      pair("direction", getDirection()),
      pair("acceleration", getAcceleration()),
      pair("shape", m_p_extras != nullptr && m_p_extras->shape ? 1 : 0),
      pair("path-nodes", static_cast<double>(getPath().getPath().size())),
      pair("follow_path", getFollowPath() ? 1 : 0),
      pair("avoid_collisions", getAvoidCollisions() ? 1 : 0)};
}

unsigned int Object::getModified() const {
  if (m_p_extras == nullptr || !m_p_extras->serialized) return kAll;
  const ObjectAttributes now = attributes();
  unsigned mask = m_p_extras->modified;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] != (*m_p_extras->serialized)[i]) mask |= 1u << i;
  }
  return mask;
}

void Object::setModified(unsigned int new_modified) {
  extras().modified = new_modified & kAll;
}

bool Object::isModified(ObjectAttribute attribute) const {
  return (getModified() & static_cast<unsigned>(attribute)) != 0;
}

std::string Object::serialize(std::string attr) {
  std::stringstream out;
  const unsigned mask = attr.empty() ? getModified() : maskOf(attr);
  if (mask != 0) Object::serialize(&out, mask);
  return out.str();
}

int Object::serialize(std::stringstream* p_ss, unsigned int attr) {
  if (p_ss == nullptr) return -1;
  const unsigned mask = attr != 0 ? attr : getModified();
  const ObjectAttributes now = attributes();
  ObjectExtras& mine = extras();
  // What was never written remains modified.
  if (!mine.serialized) mine.serialized.emplace();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if ((mask >> i & 1) == 0) continue;
    *p_ss << now[i];
    (*mine.serialized)[i] = now[i];
  }
  mine.modified &= ~mask;
  return 0;
}

int Object::deserialize(std::string s) {
  std::stringstream in(s);
  return Object::deserialize(&in, nullptr);
}

int Object::deserialize(std::stringstream* p_ss, unsigned int* p_a) {
  if (p_ss == nullptr) return -1;
  const std::string text = p_ss->str();
  unsigned mask = 0;
  int result = 0;
  const auto noteApplied = [&](ObjectAttribute attribute, int outcome) {
    mask |= static_cast<unsigned>(attribute);
    if (outcome != 0) result = -1;
  };
  const auto takeNumber = [&](ObjectAttribute attribute, const char* key, auto apply) {
    if (const auto value = numberOf(text, key)) noteApplied(attribute, apply(*value));
  };
  const auto takeVector = [&](ObjectAttribute attribute, const char* key, auto apply) {
    if (const auto value = vectorOf(text, key)) noteApplied(attribute, apply(*value));
  };
  const auto toInt = [](double value) {
    return value >= -2e9 && value <= 2e9 ? static_cast<int>(value) : -1;
  };

  takeNumber(ObjectAttribute::ID, "id", [&](double v) { return setId(toInt(v)), 0; });
  takeNumber(ObjectAttribute::ACTIVE, "active", [&](double v) { return setActive(v != 0); });
  takeNumber(ObjectAttribute::VISIBLE, "visible", [&](double v) { return setVisible(v != 0); });
  takeNumber(ObjectAttribute::NO_SOFT, "no_soft", [&](double v) { return setNoSoft(v != 0), 0; });
  takeNumber(ObjectAttribute::ALTITUDE, "altitude", [&](double v) { return setAltitude(toInt(v)); });
  takeNumber(ObjectAttribute::SOLIDNESS, "solidness",
             [&](double v) { return setSolidness(static_cast<Solidness>(toInt(v) & 3)); });
  if (const std::string type = valueOf(text, "type"); !type.empty()) {
    setType(type);
    noteApplied(ObjectAttribute::TYPE, 0);
  }
  if (const std::string sprite = valueOf(text, "animation"); !sprite.empty()) {
    noteApplied(ObjectAttribute::ANIMATION, getAnimation().getName() == sprite ? 0 : setSprite(sprite));
    if (const auto index = numberOf(text, "animation-index")) setSpriteIndex(toInt(*index));
    if (const auto count = numberOf(text, "animation-count")) setSpriteSlowdownCount(toInt(*count));
  }
  takeVector(ObjectAttribute::BOX, "box", [&](Vector corner) {
    return setBox(Box(corner, numberOf(text, "box-horizontal").value_or(getBox().width()),
                      numberOf(text, "box-vertical").value_or(getBox().height())));
  });
  takeVector(ObjectAttribute::POSITION, "pos", [&](Vector v) { return setPosition(v); });
  takeVector(ObjectAttribute::SPEED, "velocity", [&](Vector v) { return setVelocity(v); });
  takeVector(ObjectAttribute::ACCELERATION, "acceleration", [&](Vector v) { return setAcceleration(v); });
  if (p_a != nullptr) *p_a |= mask;
  return result;
}

std::string Object::toString() const {
  return getType() + " " + std::to_string(getId()) + " at " + getPosition().toString();
}

}  // namespace df
