#pragma once

#include <span>
#include <string_view>

namespace Ground
{

// A file of the page, as it is served. The bytes live as long as the program.
struct PageFile
{
    std::string_view Target;  // the path in the URL, `/` for the page itself
    std::string_view Type;    // its media type
    std::string_view Bytes;
};

// The files that were built into this program; EmbedPageFiles.cmake makes the table.
std::span<const PageFile> PageFiles();

}  // namespace Ground
