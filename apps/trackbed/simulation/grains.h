// The grains of a scene: a library of shapes, sized, drawn to the gradation by mass.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/trackbed/scene.h"
#include "dem/grading/curve.h"
#include "dem/grading/draw.h"
#include "dem/grain/library.h"

namespace trackbed::apps {

/// What the scene asks of its library of shapes.
dem::LibraryParameters library_parameters(const Scene&);

/// Makes and sizes the library, of one or two kinds of shapes (Grains/Shape, Other shape);
/// `progress` gets the share done.
std::vector<dem::GrainShape> make_grain_library(const Scene&,
                                                const std::function<void(double)>& progress);

/// The same with these parameters instead of the scene's (a smaller library).
std::vector<dem::GrainShape> make_grain_library(const Scene&, dem::LibraryParameters,
                                                const std::function<void(double)>& progress);

/// Whether the scene has grains of this shape.
bool has_shape(const Scene&, const std::string& shape);

/// The scene's gradation curve.
dem::SieveCurve gradation_curve(const Scene&);

/// Grains of the curve with the given total mass [kg]; `stream` makes independent draws.
std::vector<dem::GrainShape> draw_grains(const Scene&, const std::vector<dem::GrainShape>& library,
                                         double mass, int stream);

}  // namespace trackbed::apps
