// The layers of a subgrade, from their text in a parameter file.
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

struct Layer {
  double thickness;  ///< [m]
  double modulus;    ///< Young's [Pa]
  double poisson;    ///< [-]
  double density;    ///< [kg/m3]
};

/// "thickness:E:nu:rho, ..." from the top down. On a fault returns what came before it and says in
/// `fault` what is wrong; else leaves `fault` empty.
std::vector<Layer> parse_layers(const std::string& text, std::string& fault);

}  // namespace trackbed::apps
