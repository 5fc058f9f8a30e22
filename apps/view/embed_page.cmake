# SPDX-License-Identifier: BSD-3-Clause
# Joins the page's files and writes them as a C++ array.
#   cmake -DFOLDER=apps/view/page -DOUTPUT=page_text.cpp "-DSCRIPTS=a.js b.js" -P embed_page.cmake
set(script)
separate_arguments(SCRIPTS)
foreach(name IN LISTS SCRIPTS)
  file(READ "${FOLDER}/${name}" text)
  string(APPEND script "${text}")
endforeach()
file(READ "${FOLDER}/page.css" style)
file(READ "${FOLDER}/page.html" page)
string(REPLACE "/* style */" "${style}" page "${page}")
string(REPLACE "/* script */" "${script}" page "${page}")
# Without indentation and JavaScript's comments.
string(REGEX REPLACE "\n +" "\n" page "${page}")
string(REGEX REPLACE "\n//[^\n]*" "" page "${page}")
string(REGEX REPLACE "\n\n+" "\n" page "${page}")
file(WRITE "${OUTPUT}.html" "${page}")
file(READ "${OUTPUT}.html" bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "// Made by embed_page.cmake.
#include \"view/page.h\"

namespace lisco_apps {
namespace {

constexpr unsigned char kPage[] = {
${bytes}};

}  // namespace

std::string_view emptyViewPage() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace lisco_apps
")
