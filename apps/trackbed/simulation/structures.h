// The structures of a scene: finite element bodies and beds from its sleeper and subgrade sections.
#pragma once
#include <memory>

#include "apps/trackbed/scene.h"
#include "apps/trackbed/simulation/layout.h"
#include "fem/elastic_body.h"

namespace trackbed::apps {

/// The elastic sleeper (full, reduced or a beam) with its base at height `base` [m], free in space.
/// Its loads: the rail seats, then the push if the scene has one.
std::unique_ptr<fem::Structure> make_elastic_sleeper(const Scene&, const Layout&, double base);

/// The subgrade below z = 0 by the model that the scene names, rollers at its sides (a seam where
/// the scene is periodic). Not for "rigid".
std::unique_ptr<fem::Structure> make_subgrade_structure(const Scene&, const Layout&);

/// A rail seat, of a half sleeper what lies at x >= 0 of it; its load is even over [low, high].
struct RailSeat {
  double x;          ///< as the scene gives it [m]
  double low, high;  ///< [m]
};

/// Those that are simulated, in the scene's order. They share the simulated load evenly.
std::vector<RailSeat> rail_seats(const Scene&);

/// How many of the elastic sleeper's loads are rail seats.
int seat_loads(const Scene&);

/// What ranks other than 0 do in a run: their share of its elastic bodies, until
/// fem::release_ranks().
void serve_structures(const Scene&);

/// Boundaries of the sleeper that grains touch.
std::vector<std::string> sleeper_contact(const Scene&);

}  // namespace trackbed::apps
