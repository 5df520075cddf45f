#include "engine/world/Player.h"

#include <utility>

#include "engine/world/Controls.h"
#include "engine/world/Views.h"
#include "engine/world/WorldStore.h"
#include "shared/values/Canvas.h"

namespace df {

namespace {

constexpr std::uint32_t kTexts = 16;

}  // namespace

Player::Player(Views& views, std::uint32_t id, std::string name, Color color)
    : m_views(views), m_id(id), m_name(std::move(name)), m_color(color) {}

int Player::setObject(Object* p_o) {
  return m_views.setObject(*this, p_o);
}

Object* Player::getObject() const {
  return m_views.store().find(m_object);
}

int Player::setControls(const Controls& controls) {
  auto table = controls.table();
  if (!table) return m_views.refuse("setControls");
  m_p_controls = table->rows.empty() ? nullptr : std::make_shared<const ControlTable>(*std::move(table));
  m_control_state = {};
  return 0;
}

int Player::setText(std::uint32_t id, Vector position, const std::string& text, Color color) {
  const auto where = toFixed(position);
  if (id >= kTexts || !where || color < BLACK || color > WHITE) return m_views.refuse("setText");
  const int x = cellOf(where->x);
  const int y = cellOf(where->y);
  const int width = m_views.width();
  if (x < 0 || y < 0 || x >= width || y >= m_views.height()) return m_views.refuse("setText");

  std::string shown;
  int room = width - x;
  for (const char32_t ch : decodeUtf8(text)) {
    if (room-- == 0) break;
    appendUtf8(shown, isDrawable(ch) ? ch : U'?');
  }
  if (shown.empty()) {
    m_texts.erase(id);
  } else {
    m_texts[id] = PlayerText{id, x, y, color, std::move(shown)};
  }
  return 0;
}

PlayerFacts Player::facts() const {
  PlayerFacts f;
  f.id = m_id;
  f.name = m_name;
  f.color = m_color;
  f.score = m_score;
  // A player without their own view shares the world's view and the Object that this follows.
  f.followed = m_views.followed(this);
  f.view_corner = m_view_corner;
  for (const auto& [id, text] : m_texts) f.texts.push_back(text);
  if (m_p_controls != nullptr) f.steering = steeringFacts();
  return f;
}

SteeringFacts Player::steeringFacts() const {
  SteeringFacts f{m_p_controls, {}, m_control_state, {}, {}, {}};
  f.state.steering = false;
  const Object* p_o = getObject();
  if (p_o == nullptr) return f;
  f.object = m_object;
  f.state.steering = m_steers && p_o->isActive();
  const WorldStore& store = m_views.store();
  f.position = store.position(m_object.slot);
  f.velocity = store.velocity(m_object.slot);
  f.acceleration = store.acceleration(m_object.slot);
  return f;
}

}  // namespace df
