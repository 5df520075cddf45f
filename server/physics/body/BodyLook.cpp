#include "physics/body/BodyLook.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/ObjectLookAccess.h"
#include "engine/world/World.h"
#include "physics/body/Body.h"
#include "physics/body/BodyTable.h"

namespace naiad::physics {

namespace {

constexpr double kTurnInRadians = 6.283185307179586;

/// Returns the Object's box as a shape, relative to the Object's position.
std::vector<ConvexShape> shapeOf(const df::FixedBox& box, double aspect) {
  const double width = df::toCells(box.size.x), height = df::toCells(box.size.y) * aspect;
  const Vec2 centre = {df::toCells(box.corner.x) + width / 2,
                       df::toCells(box.corner.y) * aspect + height / 2};
  ConvexShape shape;
  if (makeBox(width / 2, height / 2, centre, {}, 0, shape) != ShapeStatus::kOk) return {};
  return {shape};
}

}  // namespace

std::uint32_t integerAngle(double angle) {
  constexpr double kUnits = 4294967296.0;
  const double units = std::floor(angle / kTurnInRadians * kUnits + 0.5);
  if (!(units >= -9e18 && units <= 9e18)) return 0;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(units));
}

void BodyLook::restyle(FrameStyle style) {
  m_style = std::move(style);
  m_made = false;
}

bool BodyLook::isUpToDate(const BodyGeometry& form, const df::FixedBox& box, double aspect) const {
  if (!m_made || aspect != m_aspect) return false;
  if (form.shapes.empty() && !(box == m_box)) return false;
  return std::equal(form.shapes.begin(), form.shapes.end(), m_shapes.begin(), m_shapes.end(), isEqual);
}

void BodyLook::update(const BodyGeometry& form, const df::FixedBox& box, double aspect, std::uint32_t tick) {
  m_new_frames = m_new_selector = false;
  // Most bodies never turn, so they have only one frame. A body that has turned once may turn again.
  const bool turns =
      m_turns || form.is_turning || form.spin != 0 || (m_made && !(form.rotation == m_rotation));
  if (turns != m_turns || !isUpToDate(form, box, aspect)) {
    m_turns = turns;
    redraw(form, box, aspect);
  }
  if (m_turn.frames.size() > 1) choose(form, tick);
}

void BodyLook::redraw(const BodyGeometry& form, const df::FixedBox& box, double aspect) {
  m_made = m_new_frames = true;
  m_shapes = form.shapes;
  m_box = box;
  m_aspect = aspect;
  m_rotation = form.rotation;
  m_selector = {};
  const std::vector<ConvexShape> shapes = m_shapes.empty() ? shapeOf(box, aspect) : m_shapes;
  m_style.spoke = m_turns && m_style.how == df::BodyDrawing::OUTLINE && m_style.ch == 0 &&
                  shapes.size() == 1 && shapes[0].count == 1;
  if (m_turns) {
    m_turn = drawTurn(shapes, aspect, m_style);
  } else {
    m_turn = {Sequence{drawShapes(shapes, form.rotation, aspect, m_style)}, 1};
  }
}

// Publishes the angle with as few bits as its allowed error needs. The spin is exact, because a freely
// turning body may keep it for any number of ticks.
void BodyLook::choose(const BodyGeometry& form, std::uint32_t tick) {
  const std::uint32_t angle = m_turn.repeats * integerAngle(angleOf(form.rotation));
  const auto width = static_cast<std::uint32_t>((std::uint64_t{1} << 32) / m_turn.frames.size());
  const auto off = static_cast<std::int32_t>(angle - m_selector.angleAt(tick));
  const auto most = static_cast<std::int32_t>(width / 4);
  if (m_selector.kind == Selector::kAngle && off >= -most && off <= most) return;
  constexpr std::uint32_t kCoarse = 1u << 20;  // 1/16 of the smallest possible width
  const auto spin = static_cast<std::int32_t>(m_turn.repeats * integerAngle(form.spin));
  m_selector = Selector::turning(tick, angle, spin);
  m_selector.angle = (m_selector.angle + kCoarse / 2) & ~(kCoarse - 1);
  m_new_selector = true;
}

}  // namespace naiad::physics

namespace df {

using naiad::physics::BodyLook;
using naiad::physics::FrameStyle;

BodyLook& Body::look() {
  if (m_look == nullptr) m_look = std::make_shared<BodyLook>();
  return *m_look;
}

int Body::setDrawing(BodyDrawing drawing, char32_t ch, Color color) {
  const bool known =
      drawing == BodyDrawing::NONE || drawing == BodyDrawing::OUTLINE || drawing == BodyDrawing::FILL;
  if (!known || (ch != 0 && !isDrawable(ch)) || color < BLACK || color > WHITE) return refuseAs("setDrawing");
  FrameStyle style;
  style.how = drawing;
  style.ch = ch;
  style.color = color;
  look().restyle(std::move(style));
  return 0;
}

int Body::setDrawing(const std::vector<std::string>& rows, Color color) {
  constexpr std::size_t kMaxSide = 128;
  FrameStyle style;
  style.how = BodyDrawing::SPRITE;
  style.color = color;
  bool good = !rows.empty() && rows.size() <= kMaxSide && color >= BLACK && color <= WHITE;
  for (const std::string& row : rows) {
    style.rows.push_back(decodeUtf8(row));
    good = good && style.rows.back().size() <= kMaxSide &&
           std::all_of(style.rows.back().begin(), style.rows.back().end(), isDrawable);
  }
  if (!good) return refuseAs("setDrawing");
  look().restyle(std::move(style));
  return 0;
}

int Body::draw() {
  const World* p_world = getWorld();
  if (p_world == nullptr) return -1;
  BodyLook& its = look();
  its.update(std::as_const(*m_table).form(m_index), toFixed(getBox()).value_or(FixedBox{}),
             m_table->metric.aspect(), static_cast<std::uint32_t>(p_world->getStepCount()));
  if (its.hasNewFrames()) {
    if (ObjectLookAccess::setFrames(*this, its.frames(), its.selector()) != 0)
      ObjectLookAccess::setFrames(*this, {}, {});
  } else if (its.hasNewSelector()) {
    ObjectLookAccess::setSelector(*this, its.selector());
  }
  return Object::draw();
}

}  // namespace df
