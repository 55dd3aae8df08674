# build_info: which sources a program is made of. Run at each build: cmake -D SOURCES=DIR -D VERSION=X -D FLAGS=... -D OUT=FILE.cpp -P
#
#   commit    of the repository, with "changed" where the sources differ from it; empty where there is none, as in a tarball
#   sources   a fingerprint of the files that decide a trial's bits: all but those that only judge, show, report or store
find_program(GIT git)
set(commit "")
if(GIT AND EXISTS ${SOURCES}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCES} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
  execute_process(COMMAND ${GIT} -C ${SOURCES} diff --quiet HEAD -- contact engine grasp devices tasks CMakeLists.txt RESULT_VARIABLE changed
                  OUTPUT_QUIET ERROR_QUIET)
  if(commit AND changed)
    string(APPEND commit ", changed")
  endif()
endif()

set(files "")
foreach(folder contact engine grasp devices tasks)
  file(GLOB_RECURSE found RELATIVE ${SOURCES} ${SOURCES}/${folder}/*.h ${SOURCES}/${folder}/*.cpp ${SOURCES}/${folder}/*.json)
  list(APPEND files ${found})
endforeach()
list(FILTER files EXCLUDE REGEX "^tasks/(.*/)?(app|bench|demo|exact|findings|measure|python|report|session|sessions|share|stress|sweep|verify|view)/")
list(SORT files)
set(sums "")
foreach(file ${files})
  file(SHA256 ${SOURCES}/${file} sum)
  string(APPEND sums "${file} ${sum}\n")
endforeach()
string(SHA256 sources "${sums}")
string(SUBSTRING ${sources} 0 12 sources)

string(REPLACE "\\" "\\\\" FLAGS "${FLAGS}")
string(REPLACE "\"" "\\\"" FLAGS "${FLAGS}")
set(text "#include \"pincer/tasks/run/session/build_info.h\"

namespace pincer::tasks {
const BuildInfo kBuildInfo{\"${VERSION}\", \"${commit}\", \"${sources}\", \"${FLAGS}\"};
}  // namespace pincer::tasks
")
set(before "")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
