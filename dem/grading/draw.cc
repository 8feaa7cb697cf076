#include "dem/grading/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "base/error.h"
#include "dem/grading/grain_form.h"
#include "dem/grain/random.h"

namespace trackbed::dem {
namespace {

std::string class_name(const DrawnClass& c) {
  char text[80];
  std::snprintf(text, sizeof text, "class %.6g to %.6g mm", 1000 * c.low, 1000 * c.high);
  return text;
}

std::string percent(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Shape indices in random order; dealt again in a new order when all are used.
class Deck {
 public:
  Deck(std::vector<int> cards, Random& random) : cards_(std::move(cards)), random_(random) {}
  bool empty() const { return cards_.empty(); }
  int deal() {
    if (next_ % cards_.size() == 0) random_.shuffle(cards_);
    return cards_[next_++ % cards_.size()];
  }

 private:
  std::vector<int> cards_;
  Random& random_;
  size_t next_ = 0;
};

// Size in (low, high] whose mass is spread evenly: number density ~ size^-3.
double class_size(double low, double high, Random& random) {
  const double a = 1 / (low * low), b = 1 / (high * high);
  return 1 / std::sqrt(a + random.uniform() * (b - a));
}

DrawnGrain grain_of_size(int index, const GrainShape& shape, double size) {
  const double s = size / shape.sieve_size;
  return {index, s, size, shape.volume * s * s * s};
}

double total(const std::vector<DrawnGrain>& grains) {
  double sum = 0;
  for (const DrawnGrain& g : grains) sum += g.volume;
  return sum;
}

// Grains are added as long as that brings the volume nearer to the target.
template <class Took, class Next>
std::vector<DrawnGrain> fill(double target, Took took, Next next) {
  std::vector<DrawnGrain> grains;
  for (double sum = 0;;) {
    const DrawnGrain g = next();
    if (std::abs(sum + g.volume - target) >= std::abs(sum - target)) return grains;
    sum += g.volume;
    grains.push_back(g);
    took(g);
  }
}

// All sizes times one factor, kept inside the class, so that the volume is the target's.
void adjust_sizes(std::vector<DrawnGrain>& grains, const std::vector<GrainShape>& library,
                  const DrawnClass& c) {
  const double low = c.low * (1 + 1e-9), high = c.high * (1 - 1e-9);
  const auto with_factor = [&](double factor) {
    std::vector<DrawnGrain> result;
    for (const DrawnGrain& g : grains)
      result.push_back(grain_of_size(g.shape, library[g.shape],
                                     std::min(high, std::max(low, factor * g.sieve))));
    return result;
  };
  double small = c.low / c.high, large = c.high / c.low;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (small + large);
    (total(with_factor(middle)) < c.target_volume ? small : large) = middle;
  }
  grains = with_factor(0.5 * (small + large));
}

void check(const std::vector<GrainShape>& library, const DrawParameters& p) {
  if (!(p.volume > 0) || !std::isfinite(p.volume))
    throw InputError("gradation draw: the volume of the grains must be positive");
  if (!(p.tolerance > 0)) throw InputError("gradation draw: the tolerance must be positive");
  if (library.empty()) throw InputError("gradation draw: the grain library is empty");
  for (size_t i = 0; i < library.size(); ++i)
    if (!(library[i].sieve_size > 0) || !(library[i].volume > 0))
      throw InputError("gradation draw: shape " + std::to_string(i) +
                       " of the library is not sized");
}

// Deals shapes of each form in turn so that the forms' volumes stay in the ratio asked for.
class FormDealer {
 public:
  FormDealer(const std::vector<GrainShape>& library, const DrawParameters& p, Random& random)
      : random_(random), controlled_(p.needle_share > 0 || p.flaky_share > 0) {
    if (!(p.needle_share >= 0) || !(p.flaky_share >= 0) || p.needle_share + p.flaky_share > 100)
      throw InputError("gradation draw: needle and flaky shares must be 0 to 100 % together");
    form_.assign(library.size(), 0);
    if (!controlled_) return;
    const std::vector<GrainForm> forms = grain_forms(library);
    for (size_t k = 0; k < forms.size(); ++k) form_[k] = static_cast<int>(forms[k]);
    share_ = {100 - p.needle_share - p.flaky_share, p.needle_share, p.flaky_share};
    const char* const names[] = {"ordinary grains", "needles", "flakes"};
    for (int f = 0; f < 3; ++f)
      if (share_[f] > 0 && std::count(form_.begin(), form_.end(), f) == 0)
        throw InputError("gradation draw: " + percent(share_[f]) + " % " + names[f] +
                         (f == 0 ? " are left beside the needles and flakes" : " are asked for") +
                         ", but the library holds none");
  }

  // The shapes to deal from.
  void open(const std::vector<int>& members) {
    decks_.clear();
    for (int f = 0; f < 3; ++f) {
      std::vector<int> cards;
      for (int k : members)
        if (form_[k] == f && (!controlled_ || share_[f] > 0)) cards.push_back(k);
      decks_.emplace_back(std::move(cards), random_);
    }
  }
  bool empty() const {
    return std::all_of(decks_.begin(), decks_.end(), [](const Deck& d) { return d.empty(); });
  }

  // A shape of the form that lags most behind its share.
  int deal() {
    int next = -1;
    for (int f = 0; f < 3; ++f)
      if (!decks_[f].empty() && (next < 0 || lag(f) > lag(next))) next = f;
    return decks_[next].deal();
  }
  void took(const DrawnGrain& g) { volume_[form_[g.shape]] += g.volume; }
  bool controlled() const { return controlled_; }
  int form(int shape) const { return form_[shape]; }

 private:
  double lag(int f) const {
    return share_[f] / 100 * (volume_[0] + volume_[1] + volume_[2]) - volume_[f];
  }
  Random& random_;
  bool controlled_;
  std::vector<int> form_;
  std::array<double, 3> share_ = {100, 0, 0};
  std::array<double, 4> volume_ = {0, 0, 0, 0};
  std::vector<Deck> decks_;
};

void check_shares(const GradationDraw& draw, const DrawParameters& p) {
  const auto one = [&](const char* name, double wanted, double achieved) {
    if (std::abs(wanted - achieved) <= p.tolerance) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "gradation draw: %.3g %% %s are asked for, %.3g %% achieved (%.3g allowed); ask "
                  "for more volume or a wider tolerance",
                  wanted, name, achieved, p.tolerance);
    throw InputError(text);
  };
  one("needles", p.needle_share, draw.needle_percent);
  one("flakes", p.flaky_share, draw.flaky_percent);
}

}  // namespace

GradationDraw draw_gradation(const SieveCurve& curve, const std::vector<GrainShape>& library,
                             const DrawParameters& p) {
  check(library, p);
  Random random(p.seed);
  std::vector<int> all(library.size());
  std::iota(all.begin(), all.end(), 0);
  FormDealer dealer(library, p, random);
  dealer.open(all);
  const auto took = [&](const DrawnGrain& g) { dealer.took(g); };
  GradationDraw result;
  for (const SieveClass& wanted : sieve_classes(curve)) {
    DrawnClass c{wanted.low, wanted.high, 0.01 * wanted.percent * p.volume, 0, 0};
    std::vector<DrawnGrain> grains;
    if (c.target_volume > 0 && p.scale) {
      grains = fill(c.target_volume, took, [&] {
        const int index = dealer.deal();
        return grain_of_size(index, library[index], class_size(c.low, c.high, random));
      });
      if (!grains.empty()) adjust_sizes(grains, library, c);
    } else if (c.target_volume > 0) {
      std::vector<int> members;
      for (int i : all)
        if (library[i].sieve_size > c.low && library[i].sieve_size <= c.high) members.push_back(i);
      dealer.open(members);
      if (dealer.empty())
        throw InputError("gradation draw: no shape of the library falls into " + class_name(c) +
                         ", which holds " + std::to_string(wanted.percent) + " % of the mass");
      grains = fill(c.target_volume, took, [&] {
        const int index = dealer.deal();
        return grain_of_size(index, library[index], library[index].sieve_size);
      });
    }
    c.achieved_volume = total(grains);
    c.count = static_cast<int>(grains.size());
    const double error = 100 * std::abs(c.achieved_volume - c.target_volume) / p.volume;
    if (error > p.tolerance) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "gradation draw: %s misses its %.3g m3 by %.3g %% of the total (%.3g allowed) "
                    "with %d grains; ask for more volume or a wider tolerance",
                    class_name(c).c_str(), c.target_volume, error, p.tolerance, c.count);
      throw InputError(text);
    }
    result.classes.push_back(c);
    result.grains.insert(result.grains.end(), grains.begin(), grains.end());
  }
  if (result.grains.empty()) throw InputError("gradation draw: the volume is less than one grain");
  random.shuffle(result.grains);
  std::vector<double> sizes, volumes;
  for (const DrawnGrain& g : result.grains) sizes.push_back(g.sieve), volumes.push_back(g.volume);
  result.volume = total(result.grains);
  result.achieved_passing = passing_percent(sizes, volumes, curve.sieve);
  if (dealer.controlled()) {
    for (const DrawnGrain& g : result.grains) {
      if (dealer.form(g.shape) == 1) result.needle_percent += 100 * g.volume / result.volume;
      if (dealer.form(g.shape) == 2) result.flaky_percent += 100 * g.volume / result.volume;
    }
    check_shares(result, p);
  }
  return result;
}

}  // namespace trackbed::dem
