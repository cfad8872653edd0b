// The text formats of the book's program: init files and snapshot frames of 25 columns.
#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sandlane::scene {

struct BookHeader {
    Vec gravity;                                    // z: angular acceleration
    double time = 0;                                // s
    double time_step = 0;                           // s
    std::int64_t steps = 0;                         // nstep
    std::int64_t print_every = 0, energy_every = 0; // nprint, nenergy: steps
    double lx = 1, ly = 1, x_0 = 0, y_0 = 0;        // periods and lower corner
    friend bool operator==(const BookHeader&, const BookHeader&) = default;
};

// One grain, in the order of the columns.
struct BookRecord {
    double x = 0, y = 0, phi = 0, vx = 0, vy = 0, omega = 0;
    double radius = 0, mass = 0;
    int type = 0;                                      // 0: free; docs/physics.md 6
    double modulus = 0;                                // column 10, Y_col = 4 Y/(3 (1 - nu^2))
    double dissipation = 0, friction = 0, damping = 0; // A, mu, gamma_t
    std::array<double, 3> force{};                     // Fx, Fy, torque
    std::array<double, 9> derivatives{};               // 2nd, 3rd, 4th of (x, y, phi)
    friend bool operator==(const BookRecord&, const BookRecord&) = default;
};

struct Book {
    BookHeader header;
    std::vector<BookRecord> records;
    friend bool operator==(const Book&, const Book&) = default;
};

// Throws Error(invalid_input) naming file, line, record and column.
[[nodiscard]] Book parse_book(std::string_view text, const std::string& file);
[[nodiscard]] std::vector<Book> parse_book_frames(std::string_view text, const std::string& file);

[[nodiscard]] std::string write_book(const Book& book);
// A frame keeps gravity, time and time step of the header.
[[nodiscard]] std::string write_book_frame(const Book& book);

// The init file as a scene: grains and walls as explicit lists, the motions of the types 2 to 6 with the
// parameters of docs/physics.md 6, one material for each set of coefficients. Time starts at 0.
[[nodiscard]] Scene scene_from_book(const Book& book, const std::string& file);

} // namespace sandlane::scene
