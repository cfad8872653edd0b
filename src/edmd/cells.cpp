// Particles of the cells: who comes and who goes.
#include "edmd/simulation.hpp"

#include <algorithm>

namespace sandlane::edmd {

void Simulation::add_to_cell(std::int64_t number, std::uint32_t i) {
    simd::HardCell* cell = &cells_[static_cast<std::size_t>(number)];
    while (cell->size() == simd::cell_slots && cell->next() != 0) cell = &cells_[cell->next()];
    if (cell->size() < simd::cell_slots) {
        cell->particle[cell->size()] = i;
        ++cell->meta;
        return;
    }
    if (free_cell_ == 0) {
        const std::size_t size = cells_.size(), from = static_cast<std::size_t>(cell - cells_.data());
        Column<simd::HardCell> larger(size + std::max<std::size_t>(16, size / 32)); // without doubling
        std::copy(cells_.begin(), cells_.end(), larger.begin());
        cells_.swap(larger);
        for (std::size_t k = size; k < cells_.size(); ++k) {
            cells_[k].link(free_cell_);
            free_cell_ = static_cast<std::uint32_t>(k);
        }
        view_.cells = cells_.data();
        cell = &cells_[from];
    }
    const std::uint32_t fresh = free_cell_;
    simd::HardCell& more = cells_[fresh];
    free_cell_ = more.next();
    more.particle[0] = i;
    more.meta = 1;
    cell->link(fresh);
}

void Simulation::take_from_cell(std::int64_t number, std::uint32_t i) {
    simd::HardCell *cell = &cells_[static_cast<std::size_t>(number)], *before = nullptr;
    for (;;) {
        const std::uint32_t size = cell->size();
        for (std::uint32_t k = 0; k < size; ++k) {
            if (cell->particle[k] != i) continue;
            cell->particle[k] = cell->particle[size - 1];
            cell->particle[size - 1] = 0;
            --cell->meta;
            if (size == 1 && before != nullptr) {
                const std::uint32_t emptied = before->next();
                before->link(cell->next());
                cell->link(free_cell_);
                free_cell_ = emptied;
            }
            return;
        }
        before = cell;
        cell = &cells_[cell->next()];
    }
}

} // namespace sandlane::edmd
