#include <cstdlib>

#include "SoftScene.h"
#include "physics/soft/SoftCrowd.h"

namespace naiad::physics {
namespace {

// A row of blobs of 8 nodes, at distances of `apart`, and the contacts between them.
class Crowd {
 public:
  Crowd(int count, double apart) {
    for (int i = 0; i < count; ++i) m_bodies.push_back(makeBlob(placeAt({apart * i, 0}), 1, 8, 1, 0, 0, 0));
    for (const SoftBody& body : m_bodies) {
      for (const SoftNode& node : body.nodes) m_ends.push_back(node.offset);
    }
    for (std::size_t i = 0; i < m_bodies.size(); ++i) {
      SoftView view;
      view.body = &m_bodies[i], view.id = static_cast<int>(i), view.ends = &m_ends[8 * i];
      view.lower = {-1.2, -1.2}, view.upper = {1.2, 1.2};
      m_views.push_back(view);
    }
    for (std::size_t i = 0; i < m_views.size(); ++i)
      m_left_out += crowd.findContacts(m_views, i, rows) ? 0 : 1;
  }
  // Returns the number of contacts of a body's nodes with other bodies.
  int rowsOf(int id) const {
    int count = 0;
    for (const SoftRow& row : rows) count += row.a.body == id ? 1 : 0;
    return count;
  }
  int leftOut() const { return m_left_out; }
  /// Returns all contacts, as they would be without the limits.
  std::vector<SoftRow> all() const {
    std::vector<SoftRow> found;
    for (const SoftView& a : m_views) {
      for (const SoftView& b : m_views) {
        if (a.id != b.id) findContacts(a, b, found);
      }
    }
    return found;
  }

  SoftCrowd crowd;
  std::vector<SoftRow> rows;

 private:
  std::vector<SoftBody> m_bodies;
  std::vector<Vec2> m_ends;
  std::vector<SoftView> m_views;
  int m_left_out = 0;
};

TEST(SoftCrowd, SmallGroupsKeepEveryContact) {
  for (const int count : {2, SoftCrowd::kMaxOthers + 1}) {
    const Crowd few(count, 0.1);
    const std::vector<SoftRow> all = few.all();
    EXPECT_EQ(few.leftOut(), 0);
    EXPECT_GT(all.size(), 4u);
    ASSERT_EQ(few.rows.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(few.rows[i].key, all[i].key);
  }
}

TEST(SoftCrowd, ContactsGrowWithBodiesNotPairs) {
  for (const int count : {50, 100, 200}) {
    const Crowd many(count, 0);
    EXPECT_EQ(many.leftOut(), count);
    for (int id = 0; id < count; ++id) {
      EXPECT_GT(many.rowsOf(id), 0) << id;
      EXPECT_LE(many.rowsOf(id), SoftCrowd::kMaxOthers) << id;
    }
  }
}

// If all bodies are in one place, each begins with a different neighbour, so that contacts are shared evenly.
TEST(SoftCrowd, ContactsAreSharedAmongTheBodies) {
  constexpr int kMany = 60;
  const Crowd many(kMany, 0);
  std::vector<int> times_touched(kMany, 0);
  for (const SoftRow& row : many.rows) ++times_touched[static_cast<std::size_t>(row.b.body)];
  for (const int times : times_touched) EXPECT_LE(times, SoftCrowd::kMaxOthers * SoftCrowd::kMaxOthers);
  EXPECT_GT(*std::min_element(times_touched.begin(), times_touched.end()), 0);
}

// Each body overlaps about twenty others in the row, but has only the deepest contacts with the nearest of
// them.
TEST(SoftCrowd, OnlyTheNearestBodiesTouch) {
  const Crowd row(100, 0.1);
  for (const SoftRow& contact : row.rows) {
    EXPECT_LE(std::abs(contact.a.body - contact.b.body), SoftCrowd::kMaxOthers) << contact.a.body;
  }
}

}  // namespace
}  // namespace naiad::physics
