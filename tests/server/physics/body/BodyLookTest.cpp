// The look of bodies: frames at some angles, turns made of frames, and the looks that are published.

#include <string>

#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Views.h"
#include "engine/world/WorldStore.h"
#include "host/snapshot/Publisher.h"
#include "physics/body/Body.h"
#include "physics/body/BodyLook.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

using test::boxShape;
using test::circleShape;

constexpr double kPi = 3.141592653589793;
constexpr double kAspect = 2;

/// Returns the rows that an appearance covers, as text.
std::vector<std::string> textOf(const Appearance& appearance) {
  std::int32_t left = 1 << 20, top = 1 << 20, right = -left, bottom = -top;
  for (const Glyph& glyph : appearance) {
    left = std::min(left, glyph.dx >> 8);
    right = std::max(right, glyph.dx >> 8);
    top = std::min(top, glyph.dy >> 8);
    bottom = std::max(bottom, glyph.dy >> 8);
  }
  if (appearance.empty()) return {};
  std::vector<std::string> rows(static_cast<std::size_t>(bottom - top + 1),
                                std::string(static_cast<std::size_t>(right - left + 1), ' '));
  for (const Glyph& glyph : appearance)
    rows[static_cast<std::size_t>((glyph.dy >> 8) - top)][static_cast<std::size_t>((glyph.dx >> 8) - left)] =
        static_cast<char>(glyph.ch);
  return rows;
}

std::vector<std::string> drawn(const ConvexShape& shape, double degrees, const FrameStyle& style = {}) {
  return textOf(drawShapes(std::span(&shape, 1), rotationBy(degrees * kPi / 180), kAspect, style));
}

using Rows = std::vector<std::string>;

TEST(BodyLook, OutlinesFollowTheEdges) {
  EXPECT_EQ(drawn(boxShape(6, 3), 0), (Rows{"+----------+", "|          |", "+----------+"}));
  EXPECT_EQ(drawn(boxShape(4, 4), 45), (Rows{"    /\\    ", "  //  \\\\  ", "//      \\\\", "\\\\      //",
                                             "  \\\\  //  ", "    \\/    "}));
  EXPECT_EQ(drawn(circleShape(4), 0), (Rows{" /----\\ ", "/      \\", "\\      /", " \\----/ "}));
}

TEST(BodyLook, ThinShapeIsDrawnAsALine) {
  EXPECT_EQ(drawn(boxShape(6, 0.3), 0), (Rows{"------------"}));
  EXPECT_EQ(drawn(boxShape(6, 0.3), 90), (Rows{"|", "|", "|", "|", "|", "|"}));
}

TEST(BodyLook, SmallShapeIsDrawnAsOneCharacter) {
  EXPECT_EQ(drawn(circleShape(0.5), 0), (Rows{"o"}));
  EXPECT_EQ(drawn(boxShape(0.5, 1), 0), (Rows{"#"}));
}

TEST(BodyLook, SpokeShowsACirclesRotation) {
  FrameStyle style;
  style.spoke = true;
  EXPECT_NE(drawn(circleShape(4), 0, style), drawn(circleShape(4), 90, style));
  EXPECT_EQ(drawn(circleShape(4), 0), drawn(circleShape(4), 90));
}

TEST(BodyLook, SpritesRotateToTheNearestCell) {
  FrameStyle style;
  style.how = df::BodyDrawing::SPRITE;
  style.rows = {U"abcd", U"efgh"};
  const auto at = [&](double degrees) {
    return textOf(drawShapes({}, rotationBy(degrees * kPi / 180), 1, style));
  };
  EXPECT_EQ(at(0), (Rows{"abcd", "efgh"}));
  EXPECT_EQ(at(180), (Rows{"hgfe", "dcba"}));
  EXPECT_EQ(at(90), (Rows{"ea", "fb", "gc", "hd"}));
}

// The area of the filled cells is about that of the shape, at any angle.
TEST(BodyLook, FilledAreaMatchesTheShape) {
  FrameStyle style;
  style.how = df::BodyDrawing::FILL;
  for (int degrees = 0; degrees < 360; degrees += 7) {
    const ConvexShape shape = boxShape(8, 6);
    const Appearance cells =
        drawShapes(std::span(&shape, 1), rotationBy(degrees * kPi / 180), kAspect, style);
    EXPECT_NEAR(static_cast<double>(cells.size()), 16 * 12 / kAspect, 8) << degrees;
  }
}

TEST(BodyLook, SymmetricShapesRepeatTheirFramesInATurn) {
  EXPECT_EQ(symmetryOf(std::vector{boxShape(4, 4)}), 4u);
  EXPECT_EQ(symmetryOf(std::vector{boxShape(4, 3)}), 2u);
  EXPECT_EQ(symmetryOf(std::vector{circleShape(3)}), 0u);
  EXPECT_EQ(symmetryOf(std::vector{boxShape(4, 4), circleShape(3)}), 1u);
  ConvexShape triangle;
  ASSERT_EQ(makePolygon(std::vector<Vec2>{{0, -3}, {3, 2}, {-3, 2}}, 0, triangle), ShapeStatus::kOk);
  EXPECT_EQ(symmetryOf(std::vector{triangle}), 1u);
  EXPECT_EQ(drawTurn(std::vector{circleShape(3)}, kAspect, {}).frames.size(), 1u);
}

TEST(BodyLook, EveryTurnFitsThePublishingLimits) {
  FrameStyle style;
  for (const df::BodyDrawing how : {df::BodyDrawing::OUTLINE, df::BodyDrawing::FILL}) {
    style.how = how;
    for (const double size : {0.01, 0.5, 3.0, 20.0, 60.0}) {
      const TurnFrames turn = drawTurn(std::vector{boxShape(size, size / 2)}, kAspect, style);
      ASSERT_GE(turn.frames.size(), 1u);
      EXPECT_LE(turn.frames.size(), kMaxFrames);
      if (turn.frames.size() > 1) {
        EXPECT_LE(encodedBits(turn.frames), 8 * kMaxLookBytes);
        EXPECT_LE(turn.frames.weight(), kMaxDictionaryGlyphs / 16) << "else it gets no name";
      }
    }
  }
}

BodyGeometry form(const ConvexShape& shape, double angle, double spin) {
  BodyGeometry its;
  its.shapes = {shape};
  its.rotation = rotationBy(angle);
  its.spin = spin;
  return its;
}

/// Returns the signed difference in radians, in [−π, π].
double between(double a, double b) {
  double off = a - b;
  while (off > kPi) off -= 2 * kPi;
  while (off < -kPi) off += 2 * kPi;
  return off;
}

// Ten minutes of game time. The error of the integer spin stays below a part of a frame.
TEST(BodyLook, SteadilyTurningBodyKeepsItsSelector) {
  for (const double spin : {0.1, -0.031, 3.0, 1e-5}) {
    BodyLook look;
    look.update(form(boxShape(6, 3), 0.3, spin), {}, kAspect, 1);
    ASSERT_TRUE(look.hasNewFrames());
    for (std::uint32_t tick = 2; tick < 20'000; ++tick) {
      look.update(form(boxShape(6, 3), 0.3 + spin * (tick - 1), spin), {}, kAspect, tick);
      ASSERT_FALSE(look.hasNewFrames() || look.hasNewSelector()) << spin << " in tick " << tick;
    }
  }
}

// The shown angle has an error of at most three quarters of a frame, for any motion of the body.
TEST(BodyLook, ShownFrameIsNearTheAngle) {
  SplitMix64 random(1);
  for (const ConvexShape& shape : {boxShape(6, 3), boxShape(4, 4), circleShape(5)}) {
    BodyLook look;
    double angle = 0, spin = 0.1;
    for (std::uint32_t tick = 1; tick < 3000; ++tick) {
      if (random.below(20) == 0) spin = (random.unit() - 0.5) * 2;
      if (random.below(200) == 0) angle = random.unit() * 6;
      angle += spin;
      look.update(form(shape, angle, spin), {}, kAspect, tick);
      const std::size_t frames = look.frames().size();
      ASSERT_GT(frames, 1u);
      const std::size_t shown = look.selector().at(tick, frames);
      const double repeats = shape.count == 1 ? 1 : symmetryOf(std::vector{shape});
      const double whole = 2 * kPi * static_cast<double>(shown) / static_cast<double>(frames);
      const double off = between(std::remainder(angle * repeats, 2 * kPi), whole);
      ASSERT_LE(std::abs(off), 0.76 * 2 * kPi / static_cast<double>(frames)) << tick;
    }
  }
}

TEST(BodyLook, NonTurningBodyHasOneFrame) {
  BodyLook look;
  look.update(form(boxShape(6, 3), 0.5, 0), {}, kAspect, 1);
  EXPECT_EQ(look.frames().size(), 1u);
  look.update(form(boxShape(6, 3), 0.5, 0), {}, kAspect, 2);
  EXPECT_FALSE(look.hasNewFrames());
  look.update(form(boxShape(6, 3), 0.6, 0), {}, kAspect, 3);
  EXPECT_TRUE(look.hasNewFrames());
  EXPECT_GT(look.frames().size(), 1u);
}

TEST(BodyLook, AnglesBecomeIntegersThatWrap) {
  EXPECT_EQ(integerAngle(0), 0u);
  EXPECT_EQ(integerAngle(kPi), 1u << 31);
  EXPECT_EQ(integerAngle(-kPi / 2), 3u << 30);
  EXPECT_EQ(integerAngle(7 * kPi), 1u << 31);
}

/// A world with one body, and its publisher.
class DrawnBody : public df::test::WorldTest {
 protected:
  DrawnBody() {
    world.store().setWatched(true);
    world.input().join("Ann", df::WHITE);
    body.setPosition(df::Vector(30, 12));
    body.setSolidness(df::SPECTRAL);
  }
  /// Returns how many looks are published in `ticks`. Checks that each of them draws what the world drew.
  int countLooks(int ticks, double spin) {
    int looks = 0;
    body.setSpin(spin);
    for (int i = 0; i < ticks; ++i) {
      body.setAngle(m_angle += spin);
      world.tick();
      publisher.update(world.picture().view());
      for (const Publisher::Change& change : publisher.changes()) {
        looks += change.slot == body.key().slot && (change.groups & kLook) != 0 ? 1 : 0;
      }
      const ObjectState& state = publisher.find(body.key().slot)->state;
      df::Canvas seen(world.views().width(), world.views().height());
      for (const Glyph& glyph : *state.look.select(publisher.tick())) {
        const CellPosition cell = glyphCell(positionAt(state.motion, publisher.tick()), glyph);
        seen.put(cell.x, cell.y, {glyph.ch, glyph.color});
      }
      EXPECT_EQ(countDifferences(seen, world.picture().render({})), 0) << "tick " << publisher.tick();
    }
    return looks;
  }

  df::Body body;
  Publisher publisher;

 private:
  double m_angle = 0;
};

TEST_F(DrawnBody, TurningBodyIsPublishedOncePerSpinChange) {
  body.setBoxShape(10, 4);
  EXPECT_EQ(countLooks(1000, 0.05), 1);
  EXPECT_EQ(countLooks(1000, 0.05), 0);
  EXPECT_EQ(countLooks(1000, -0.3), 1);
  EXPECT_EQ(countLooks(1000, 0), 1);
}

// If the engine turns the body, only its path is published after its creation, and less and less often.
TEST_F(DrawnBody, FreelyFlyingTurningBodyPublishesOnlyMotion) {
  body.setBoxShape(10, 4);
  body.setTurning();
  body.setSpin(0.05);
  body.setVelocity(df::Vector(0.01, 0));
  std::size_t published = 0;
  for (int i = 0; i < 1000; ++i) {
    world.tick();
    publisher.update(world.picture().view());
    published += publisher.changes().size();
    for (const Publisher::Change& change : publisher.changes())
      ASSERT_EQ(change.groups, i == 0 ? +kAllGroups : +kMotion) << i;
  }
  EXPECT_NEAR(between(body.getAngle(), std::remainder(50.0, 2 * kPi)), 0, 1e-9);
  EXPECT_LE(published, 4u) << "a path that outlives its horizon is published again";
}

TEST_F(DrawnBody, TurningCircleAndSpriteArePublishedOnce) {
  body.setCircle(4);
  EXPECT_EQ(countLooks(500, 0.05), 1);
  body.setDrawing({"<==", "|o>"}, df::RED);
  EXPECT_EQ(countLooks(500, 0.05), 1);
}

TEST_F(DrawnBody, InvalidDrawingsAreRefused) {
  EXPECT_EQ(body.setDrawing(df::BodyDrawing::OUTLINE, U'\n'), -1);
  EXPECT_EQ(body.setDrawing(df::BodyDrawing::SPRITE), -1);
  EXPECT_EQ(body.setDrawing(std::vector<std::string>{}), -1);
  EXPECT_EQ(body.setDrawing({"\x1b[2J"}), -1);
  EXPECT_EQ(body.setDrawing({std::string(129, 'x')}), -1);
  EXPECT_EQ(body.setDrawing(df::BodyDrawing::FILL, U'x', df::RED), 0);
}

}  // namespace
}  // namespace naiad::physics
