// Tiles of cells: every cell has a number of its own, every tile knows where its particles come from.
#include "dsmc/tiling.hpp"

#include <gtest/gtest.h>

#include <set>

using namespace sandlane;

TEST(Tiling, NumbersAndNeighbours) {
    struct Case {
        std::int32_t cells[3];
        bool periodic[3];
        double per_cell;
    };
    for (const Case& c :
         {Case{{22, 22, 22}, {true, true, true}, 10}, Case{{1000, 1, 1}, {false, true, true}, 40},
          Case{{37, 50, 1}, {true, false, true}, 30}, Case{{9, 9, 9}, {true, true, false}, 800},
          Case{{1, 1, 1}, {true, true, true}, 1e6}}) {
        const dsmc::Tiling tiling(c.cells, c.periodic, c.per_cell);
        std::set<std::int32_t> seen;
        for (std::int32_t z = 0; z < c.cells[2]; ++z)
            for (std::int32_t y = 0; y < c.cells[1]; ++y)
                for (std::int32_t x = 0; x < c.cells[0]; ++x) {
                    const std::int32_t cell[3] = {x, y, z};
                    double number = 0;
                    for (int d = 0; d < 3; ++d)
                        number += laws::cell_number(tiling.axis(d, -1.0, c.cells[d] * 0.25 - 1),
                                                    cell[d] * 0.25 - 0.9);
                    const auto n = static_cast<std::int32_t>(number);
                    EXPECT_TRUE(seen.insert(n).second);
                    EXPECT_LT(n, tiling.numbers());
                    const auto back = tiling.cell(n);
                    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(back[d], cell[d]);
                }
        for (std::int32_t t = 0; t < tiling.tiles(); ++t) {
            std::int32_t before = -1;
            for (const dsmc::Neighbour& source : tiling.sources(t)) {
                EXPECT_GT(source.tile, before); // the order that sorting keeps
                before = source.tile;
                EXPECT_EQ(tiling.slot(source.tile, t), source.slot);
                EXPECT_NE(source.slot, tiling.far_slot());
            }
            std::size_t near = 0;
            for (std::int32_t from = 0; from < tiling.tiles(); ++from)
                if (from != t && tiling.slot(from, t) != tiling.far_slot()) ++near;
            EXPECT_EQ(near, tiling.sources(t).size());
        }
    }
}

// The upper face belongs to the last cell.
TEST(Tiling, Faces) {
    const dsmc::Tiling tiling({10, 1, 1}, {false, true, true}, 10);
    const laws::CellAxis axis = tiling.axis(0, 0, 1);
    EXPECT_EQ(tiling.cell(static_cast<std::int32_t>(laws::cell_number(axis, 1.0)))[0], 9);
    EXPECT_EQ(tiling.cell(static_cast<std::int32_t>(laws::cell_number(axis, 0.0)))[0], 0);
    EXPECT_EQ(tiling.cell(static_cast<std::int32_t>(laws::nearest_cell_number(axis, -0.1)))[0], 0);
}
