# Writes a C++ file with the contents of the page's files: cmake -D OUTPUT=<file> -D FILES=<path|target>,... -P this
# Each file becomes one string literal of hexadecimal escapes.
string(REPLACE "," ";" FILES "${FILES}")
set(literals "")
set(table "")
set(count 0)
foreach(entry IN LISTS FILES)
  string(REPLACE "|" ";" entry "${entry}")
  list(GET entry 0 path)
  list(GET entry 1 target)
  get_filename_component(extension "${path}" LAST_EXT)
  if(extension STREQUAL .html)
    set(type "text/html; charset=utf-8")
  elseif(extension STREQUAL .css)
    set(type "text/css; charset=utf-8")
  elseif(extension STREQUAL .js)
    set(type "text/javascript; charset=utf-8")
  elseif(extension STREQUAL .svg)
    set(type "image/svg+xml")
  else()
    message(FATAL_ERROR "${path}: no media type is known for ${extension}")
  endif()
  file(READ "${path}" hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "(..)" "\\\\x\\1" escaped "${hex}")
  string(APPEND literals "const char File${count}[] = \"${escaped}\";\n")
  string(APPEND table "    {\"${target}\", \"${type}\", {File${count}, ${size}}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"PageFiles.h\"

namespace Ground
{
namespace
{
${literals}
const PageFile Files[] = {
${table}};
}  // namespace

std::span<const PageFile> PageFiles()
{
    return Files;
}

}  // namespace Ground
")
