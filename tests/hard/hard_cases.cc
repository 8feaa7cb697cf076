// hard_cases DIR [--slow] [--only WORDS]: every hard case over shapes, laws, step shares and
// schedules; DIR/hard_cases.csv, what cases are drawn by in DIR/curves.csv, and the stability map
// DIR/map.csv. Exit 1 if a promise is broken.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "cases/hard_case.h"
#include "two_masses.h"

namespace trackbed::hard {
namespace {

std::string quoted(const std::string& text) { return '"' + text + '"'; }

const char* verdict(const Measured& m) {
  if (!m.judged) return "reported";
  return m.value <= m.bound ? "holds" : "BROKEN";
}

// Rows of the table; returns how many promises are broken.
int run_cases(const std::string& file, bool slow, const std::string& only) {
  std::ofstream out(file);
  out << "group,case,must_hold,damping,shape,law,step_share,schedule,grain_steps,measured,bound,"
         "unit,"
         "verdict,wall_s\n";
  out.precision(6);
  int broken = 0;
  for (const Group& group : groups())
    for (const Case& c : group.cases) {
      if ((c.slow && !slow) || c.name.find(only) == std::string::npos) continue;
      int done = 0, failed = 0;
      for (const Setting& s : settings(c)) {
        const auto begun = std::chrono::steady_clock::now();
        const Measured m = c.run(s);
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begun;
        if (std::isnan(m.value) && !m.judged) continue;
        const double value = std::isfinite(m.value) ? m.value : 1e300;
        out << quoted(group.name) << ',' << quoted(c.name) << ',' << quoted(c.must) << ','
            << quoted(c.damping) << ',' << s.shape << ',' << s.law << ',' << s.share << ','
            << s.schedule << ',' << s.grain_steps << ',' << value << ',' << m.bound << ','
            << quoted(c.unit) << ',' << verdict(m) << ',' << wall.count() << '\n';
        ++done, failed += m.judged && !(m.value <= m.bound);
      }
      out.flush();
      std::fprintf(stderr, "%-52s %3d settings, %d broken\n", c.name.c_str(), done, failed);
      broken += failed;
    }
  return broken;
}

// What a case is drawn by: the first shape under each law.
void write_curves(const std::string& file, bool slow, const std::string& only) {
  std::ofstream out(file);
  out << "case,shape,law,schedule,x_name,y_name,log_x,log_y,x,y\n";
  out.precision(10);
  for (const Case& c : all_cases()) {
    if (!c.curve || (c.slow && !slow) || c.name.find(only) == std::string::npos) continue;
    std::set<std::string> drawn;
    for (const Setting& s : settings(c)) {
      if (!drawn.insert(s.law + s.schedule).second) continue;
      const Curve curve = c.curve(s);
      for (const auto& [x, y] : curve.points)
        out << quoted(c.name) << ',' << s.shape << ',' << s.law << ',' << s.schedule << ','
            << quoted(curve.x) << ',' << quoted(curve.y) << ',' << curve.log_x << ',' << curve.log_y
            << ',' << x << ',' << y << '\n';
    }
  }
}

// Growth per step of a grain on a column of finite elements: half of omega dt, contact over ground
// stiffness, sub-cycling.
void write_map(const std::string& file) {
  std::ofstream out(file);
  out << "schedule,grain_steps,step_share,stiffness_ratio,mass,growth\n";
  out.precision(10);
  const auto row = [&](const char* schedule, int n) {
    for (const double ratio : {1e-2, 1e-1, 1., 1e1, 1e2, 1e3, 1e4})
      for (const double share : {.01, .02, .05, .1, .2, .3, .5, .7, .9}) {
        coupling::TwoMasses m;
        m.contact = ratio * m.ground;
        double growth = 1e300;
        try {
          growth = coupling::growth(2 * share, coupling::exchange(schedule, n), m,
                                    coupling::Ground::element);
        } catch (const std::exception&) {  // refused, or not converged
        }
        out << schedule << ',' << n << ',' << share << ',' << ratio << ',' << m.mass << ','
            << (std::isfinite(growth) ? growth : 1e300) << '\n';
      }
  };
  row("predicted", 1), row("explicit", 1), row("lagged", 1);
  for (const int n : {2, 5, 10, 20}) row("several_steps", n);
}

}  // namespace
}  // namespace trackbed::hard

int main(int argc, char** argv) {
  bool slow = false;
  std::string folder, only;
  for (int k = 1; k < argc; ++k) {
    if (!std::strcmp(argv[k], "--slow"))
      slow = true;
    else if (!std::strcmp(argv[k], "--only") && k + 1 < argc)
      only = argv[++k];
    else
      folder = argv[k];
  }
  if (folder.empty()) {
    std::fprintf(stderr, "hard_cases DIR [--slow] [--only WORDS]: a folder is needed\n");
    return 2;
  }
  std::filesystem::create_directories(folder);
  const int broken = trackbed::hard::run_cases(folder + "/hard_cases.csv", slow, only);
  trackbed::hard::write_curves(folder + "/curves.csv", slow, only);
  trackbed::hard::write_map(folder + "/map.csv");
  std::printf("%d promises broken; %s/hard_cases.csv, %s/map.csv\n", broken, folder.c_str(),
              folder.c_str());
  return broken > 0;
}
