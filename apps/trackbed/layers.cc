#include "apps/trackbed/layers.h"

#include <algorithm>

#include "apps/trackbed/parameters.h"

namespace trackbed::apps {

std::vector<Layer> parse_layers(const std::string& text, std::string& fault) {
  std::vector<Layer> layers;
  fault.clear();
  if (text.empty()) return layers;
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    const std::string piece = text.substr(at, comma - at);
    at = comma + 1;
    std::string list = piece;
    std::replace(list.begin(), list.end(), ':', ',');
    std::vector<double> v;
    const std::string which = "layer " + std::to_string(layers.size() + 1);
    if (!parse_numbers(list, v) || v.size() != 4)
      fault = which + " '" + piece + "' is not of the form thickness:E:nu:density";
    else if (v[0] <= 0)
      fault = which + " needs a thickness above 0 m";
    else if (v[1] <= 0)
      fault = which + " needs a modulus above 0 Pa";
    else if (v[2] < 0 || v[2] >= 0.5)
      fault = which + " needs a Poisson's ratio from 0 to below 0.5";
    else if (v[3] <= 0)
      fault = which + " needs a density above 0 kg/m3";
    if (!fault.empty()) return layers;
    layers.push_back({v[0], v[1], v[2], v[3]});
  }
  return layers;
}

}  // namespace trackbed::apps
