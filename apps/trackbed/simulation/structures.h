// The structures of a scene: finite element bodies and beds from its sleeper and subgrade sections.
#pragma once
#include <memory>

#include "apps/trackbed/scene.h"
#include "apps/trackbed/simulation/layout.h"
#include "fem/elastic_body.h"

namespace trackbed::apps {

/// The elastic sleeper with its base at height `base` [m], free in space, its rail seats as loads.
std::unique_ptr<fem::ElasticBody> make_elastic_sleeper(const Scene&, const Layout&, double base);

/// The subgrade below z = 0 by the model that the scene names, rollers at its sides (a seam where
/// the scene is periodic). Not for "rigid".
std::unique_ptr<fem::Structure> make_subgrade_structure(const Scene&, const Layout&);

/// Boundaries of the sleeper that grains touch.
std::vector<std::string> sleeper_contact(const Scene&);

}  // namespace trackbed::apps
