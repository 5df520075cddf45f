#include "engine/widgets/ViewObject.h"

#include "engine/managers/DisplayManager.h"
#include "engine/world/ConfigText.h"
#include "engine/world/Geometry.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

ViewObject::ViewObject() {
  Object::setSolidness(SPECTRAL);
  Object::setAltitude(MAX_ALTITUDE);
  Object::setType("ViewObject");
  showOnView();
  registerInterest(VIEW_EVENT);
  ViewObject::setLocation(TOP_CENTER);
}

// The value of the location is 3 * row + column, each 0 to 2.
void ViewObject::setLocation(ViewObjectLocation new_location) {
  if (new_location < TOP_LEFT || new_location > BOTTOM_RIGHT) return;
  const double width = DM.getHorizontal();
  const double height = DM.getVertical();
  const int column = new_location % 3;
  const int row = new_location / 3;
  const double margin = m_border ? 1 : 0;
  const double y = row == 0 ? margin : row == 1 ? std::floor(height / 2) : height - 1 - margin;
  Object::setPosition(Vector(width * (1 + 2 * column) / 6, y));
  m_location = new_location;
}

int ViewObject::setPosition(Vector new_pos) {
  m_location = UNDEFINED;
  return Object::setPosition(new_pos);
}

void ViewObject::setBorder(bool new_border) {
  if (m_border == new_border) return;
  m_border = new_border;
  setLocation(m_location);
}

int ViewObject::eventHandler(const Event* p_e) {
  if (p_e->getType() != VIEW_EVENT) return 0;
  const auto* p_view = dynamic_cast<const EventView*>(p_e);
  if (p_view == nullptr || p_view->getTag() != m_view_string) return 0;
  setValue(p_view->getDelta() ? m_value + p_view->getValue() : p_view->getValue());
  return 1;
}

int ViewObject::draw() {
  std::string text = m_border ? " " : "";
  text += m_view_string;
  if (m_draw_value && !m_view_string.empty()) text += ' ';
  if (m_draw_value) text += std::to_string(m_value);
  if (m_border) text += ' ';
  return drawText(text);
}

int ViewObject::drawText(const std::string& text) const {
  const Vector at = viewToWorld(getPosition());
  if (DM.drawString(at, text, CENTER_JUSTIFIED, m_color) != 0) return -1;
  if (!m_border) return 0;
  const auto length = static_cast<double>(text.size());
  const double left = at.x() - std::floor(length / 2);
  std::string bar(text.size() + 2, '-');
  bar.front() = bar.back() = '+';
  for (const double y : {at.y() - 1, at.y() + 1})
    DM.drawString(Vector(left - 1, y), bar, LEFT_JUSTIFIED, m_color);
  DM.drawCh(Vector(left - 1, at.y()), '|', m_color);
  return DM.drawCh(Vector(left + length, at.y()), '|', m_color);
}

std::string ViewObject::serialize(std::string attr) {
  return Object::serialize(attr) + "view_string:" + m_view_string + ",value:" + std::to_string(m_value) +
         ",color:" + std::to_string(m_color) + ",location:" + std::to_string(m_location) + ",";
}

int ViewObject::deserialize(std::string s) {
  const int result = Object::deserialize(s);
  const std::string value = valueOf(s, "value");
  if (!value.empty()) setValue(std::atoi(value.c_str()));
  const std::string view_string = valueOf(s, "view_string");
  if (!view_string.empty()) setViewString(view_string);
  return result;
}

}  // namespace df
