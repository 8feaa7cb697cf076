// The structures of a scene: FE bodies from its sleeper and subgrade sections.
#pragma once
#include <memory>

#include "apps/trackbed/scene.h"
#include "apps/trackbed/simulation/layout.h"
#include "fem/elastic_body.h"

namespace trackbed::apps {

/// The elastic sleeper with its base at height `base` [m], free in space, its rail seats as loads.
std::unique_ptr<fem::ElasticBody> make_elastic_sleeper(const Scene&, const Layout&, double base);

/// The elastic subgrade below z = 0, held at its base, rollers at the sides (a seam where the
/// scene is periodic).
std::unique_ptr<fem::ElasticBody> make_elastic_subgrade(const Scene&, const Layout&);

/// Boundaries of the sleeper that grains touch.
std::vector<std::string> sleeper_contact(const Scene&);

}  // namespace trackbed::apps
