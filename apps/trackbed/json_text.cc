#include "apps/trackbed/json_text.h"

#include <cctype>
#include <map>

#include "base/error.h"

namespace trackbed::apps {
namespace {

/// deal.II writes "Contact modulus" as "Contact_20modulus". It does so with what is neither letter
/// nor digit only: "my_bed" stays.
std::string demangled(const std::string& name) {
  std::string plain;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool hex = name[i] == '_' && i + 2 < name.size() && std::isxdigit(name[i + 1]) &&
                     std::isxdigit(name[i + 2]);
    const int code = hex ? std::stoi(name.substr(i + 1, 2), nullptr, 16) : 0;
    if (code < 128 && std::isprint(code) && !std::isalnum(code)) {
      plain += static_cast<char>(code);
      i += 2;
    } else {
      plain += name[i];
    }
  }
  return plain;
}

class JsonReader {
 public:
  JsonReader(const std::string& file, const std::string& text) : file_(file), text_(text) {}

  std::vector<SceneEntry> read() {
    object("");
    if (peek() != '\0') wrong("text after the closing brace");
    return std::move(entries_);
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const {
    throw InputError(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
      if (text_[at_++] == '\n') ++line_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  void expect(char c) {
    if (peek() != c)
      wrong(std::string("'") + c + "' is missing" +
            (at_ < text_.size() ? std::string(" before '") + text_[at_] + "'" : ""));
    ++at_;
  }

  std::string quoted() {
    expect('"');
    std::string value;
    while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) {
        ++at_;
        value += text_[at_] == 'n' ? '\n' : text_[at_] == 't' ? '\t' : text_[at_];
      } else {
        value += text_[at_];
      }
      ++at_;
    }
    if (at_ >= text_.size() || text_[at_] != '"') wrong("a text has no closing quote");
    ++at_;
    return value;
  }

  std::string scalar() {
    const char c = peek();
    if (c == '"') return quoted();
    if (c == '[') {
      ++at_;
      std::string list;
      while (peek() != ']') {
        if (!list.empty()) {
          expect(',');
          list += ", ";
        }
        list += scalar();
      }
      ++at_;
      return list;
    }
    std::string word;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                  text_[at_] == '.' || text_[at_] == '+' || text_[at_] == '-'))
      word += text_[at_++];
    if (word.empty()) wrong("a value is missing");
    return word;
  }

  /// Either a section, or deal.II's {"value": ..., "documentation": ...} of one entry.
  void object(const std::string& section) {
    expect('{');
    while (peek() != '}') {
      const int line = (peek(), line_);
      const std::string name = demangled(quoted());
      const SceneEntry here{section, name, "", file_, line};
      expect(':');
      if (peek() == '{') {
        if (!entry_object(here)) object(here.path());
      } else {
        SceneEntry entry = here;
        entry.value = scalar();
        add(entry);
      }
      if (peek() != '}') expect(',');
    }
    ++at_;
  }

  bool entry_object(SceneEntry entry) {
    const auto at = at_;
    const int line = line_;
    expect('{');
    if (peek() == '"' && quoted() == "value") {
      expect(':');
      entry.value = scalar();
      while (peek() == ',') {
        ++at_;
        quoted();
        expect(':');
        scalar();
      }
      expect('}');
      add(entry);
      return true;
    }
    at_ = at;
    line_ = line;
    return false;
  }

  void add(const SceneEntry& entry) {
    const auto [earlier, fresh] = seen_.emplace(entry.path(), entry.line);
    if (!fresh)
      throw InputError(entry.place() + ": " + entry.path() + " is set twice, first in line " +
                       std::to_string(earlier->second));
    entries_.push_back(entry);
  }

  const std::string& file_;
  const std::string& text_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::map<std::string, int> seen_;
  std::vector<SceneEntry> entries_;
};

}  // namespace

std::vector<SceneEntry> read_json_text(const std::string& file, const std::string& text) {
  return JsonReader(file, text).read();
}

}  // namespace trackbed::apps
