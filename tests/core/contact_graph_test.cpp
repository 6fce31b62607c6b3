// Who stays in touch with whom: answers that do not depend on how the graph came about.

#include "core/contacts/contact_graph.hpp"

#include "core/archive.hpp"
#include "tests/catch.hpp"

using namespace kairos;

TEST_CASE("partners go by name whatever came first, and so does a graph that is read back",
          "[contacts]") {
  const std::vector<std::uint32_t> rank{2, 0, 3, 1};  // by name: 1, 3, 0, 2
  const std::vector<BodyIndex> in_order{1, 3, 2};

  ContactGraph graph(rank);
  graph.join(0, 2);
  graph.join(3, 0);
  graph.join(1, 0);
  CHECK(graph.partners(0) == in_order);

  Archive written;
  graph.persist(written);
  ContactGraph resumed(rank);
  Archive read(written.bytes());
  resumed.persist(read);
  CHECK(resumed.partners(0) == in_order);

  graph.part(0, 3);
  graph.join(3, 0);
  CHECK(graph.partners(0) == in_order);
}
