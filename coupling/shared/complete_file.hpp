// Files that are whole or absent, whatever stops the job or the machine.
#pragma once

#include <string>

namespace gasgrain {

// Asks the operating system to have a file, or the entries of a directory, on the disk. Throws
// UserError.
void put_on_disk(const std::string& path);

// Gives the complete and closed file `part` the name `path` in the same directory; its content
// is on the disk before it has that name, its name when this returns, and it replaces another file
// in one move. Throws UserError.
void complete_file(const std::string& part, const std::string& path);

}  // namespace gasgrain
