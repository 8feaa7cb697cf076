// Which pairs may touch before the next search: cell grid over the grains' boxes, grown by half
// a skin; rigid bodies (walls, plate, sleeper: large, few) are tested against all grains by their
// boxes and face planes. Boxes of angular grains meet long before the grains do: pairs that an axis
// keeps apart by more than the skin are dropped, two of three in a dense bed. Bodies of several
// parts hand over to them (part_pairs). The list holds until some body's surface may have travelled
// half a skin.
//
// Travel of body i [m]: sum over all steps of |v| dt + radius |turn|, an upper bound of the way of
// its points. It only grows; the same number tells each pair when to look again (Pairs::wake).
#pragma once
#include <utility>
#include <vector>

#include "dem/contact/pairs.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/motion.h"

namespace trackbed::dem {

struct CandidateSettings {
  double skin = 0;          ///< [m]; 0 = a tenth of the mean grain radius
  bool rigid_pairs = true;  ///< search rigid bodies against each other too
};

class Candidates {
 public:
  Candidates() = default;
  explicit Candidates(const CandidateSettings& s) : settings_(s) {}

  /// To be called after drift: adds the step's travel and searches anew if need be. History of
  /// pairs that stay is kept, a touching pair always stays. True when the list was rebuilt.
  bool update(const Bodies&, const ShapeTable&, const StepContext&, Pairs&);

  /// The first half of update: adds the step's travel; whether to search anew, as some body came
  /// further since the last search than the skin allows, or to where is no finite place.
  bool outdated(const Bodies&, const ShapeTable&, const StepContext&);

  /// Searches now; first call of a stage, or after bodies were added or moved by hand.
  void rebuild(const Bodies&, const ShapeTable&, const StepContext&, Pairs&);

  /// All that a checkpoint must hold besides the pairs.
  struct State {
    double skin = 0;                    ///< [m]
    long rebuilds = 0;                  ///< searches so far
    std::vector<double> travel;         ///< of each body since the start [m]
    std::vector<double> travel_search;  ///< its value at the last search [m]
  };
  const State& state() const { return state_; }
  void restore(const State& s) { state_ = s; }
  const std::vector<double>& travel() const { return state_.travel; }
  double skin() const { return state_.skin; }

 private:
  struct Box {
    Vec3 low, high;
  };
  void find_radii(const Bodies&, const ShapeTable&);
  void make_boxes(const Bodies&, const ShapeTable&, int threads);
  void search_grains(const Bodies&, const StepContext&);
  void search_rigid(const Bodies&, const ShapeTable&, const StepContext&);
  void carry_history(int bodies, Pairs&);
  /// Indices of pairs that may touch before the next search.
  std::vector<int> near_pairs(const Bodies&, const ShapeTable&, const StepContext&, Pairs&) const;

  CandidateSettings settings_;
  State state_;
  std::vector<double> radius_;              // of each body
  std::vector<Box> boxes_;                  // grown by half a skin
  std::vector<std::pair<int, int>> found_;  // of the search under way
  std::vector<PairKey> keys_;               // their parts
};

}  // namespace trackbed::dem
