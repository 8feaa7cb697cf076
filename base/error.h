// The two ways a run can end early. `main` turns InputError into exit code 2 and
// RunError into exit code 1, each as one clear line on standard error.
#pragma once
#include <stdexcept>
#include <string>

namespace trackbed {

/// The user's input is wrong: the text names the file or key, what was given, what is allowed.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A run that cannot go on: the text names step, grain or contact, likely cause and remedy.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace trackbed
