// Reading and writing whole files so that a failure never destroys what was there.
#pragma once
#include <string>

namespace trackbed::apps {

/// The whole text. Throws InputError if there is no such file or it cannot be read.
std::string read_text(const std::string& file);

/// The name next to `file` under which its next version is written.
std::string aside_name(const std::string& file);

/// Brings a complete file written under aside_name(file) to the disk and puts it in the place of
/// `file` in one step. Throws RunError naming the file.
void rename_into_place(const std::string& file);

/// Writes aside, then renames: afterwards the file holds the old or the new text, never a part.
/// Throws RunError naming the file (full disk, folder gone).
void write_aside_then_rename(const std::string& file, const std::string& text);

}  // namespace trackbed::apps
