# bundle: the page of a shared replay without its data, as a C++ table. cmake -D PAGE=DIR -D WORK=DIR -D OUT=FILE.cpp -P
#
# npm fetches what package-lock.json pins, by checksum, once; esbuild makes one program of it. Where that can't be had the table holds the reason
# in the page's place, and pincer builds all the same.
function(write_shell missing)
  set(table "")
  set(pieces "{}")
  if(missing STREQUAL "")
    set(missing nullptr)
    set(pieces kPieces)
    file(READ ${WORK}/page.html html)
    string(LENGTH "${html}" length)
    set(from 0)
    string(APPEND table "constexpr std::string_view kPieces[] = {\n")
    while(from LESS length)  # compilers need not take longer texts
      string(SUBSTRING "${html}" ${from} 12000 piece)
      string(APPEND table "R\"pincer-page(${piece})pincer-page\",\n")
      math(EXPR from "${from} + 12000")
    endwhile()
    string(APPEND table "};\n")
  else()
    set(missing "\"${missing}\"")
  endif()
  file(WRITE ${OUT} "#include \"pincer/tasks/share/web_page.h\"

namespace pincer::tasks {
namespace {
${table}}  // namespace

const PageShell kPageShell = {${pieces}, ${missing}};

}  // namespace pincer::tasks
")
endfunction()

set(again "then build again after removing ${OUT}.")
find_program(NODE node)
find_program(NPM npm)
if(NOT NODE OR NOT NPM)
  write_shell("it needs npm and node 18 or later, and found none. Install them (Debian: apt-get install npm), ${again}")
  return()
endif()
file(MAKE_DIRECTORY ${WORK})
file(COPY ${PAGE}/ DESTINATION ${WORK})
# What was fetched stays as long as the lock file does: a change of the page's own parts needs no network.
file(SHA256 ${PAGE}/package-lock.json lock)
set(fetched ${WORK}/node_modules/fetched.${lock})
if(NOT EXISTS ${fetched})
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --silent --fetch-retries=1 --fetch-timeout=60000 WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed
                  OUTPUT_FILE ${WORK}/npm.log ERROR_FILE ${WORK}/npm.log TIMEOUT 300)
  if(failed)
    write_shell("npm couldn't fetch three.js and esbuild (${WORK}/npm.log). It needs the network, once; ${again}")
    return()
  endif()
  file(WRITE ${fetched} "")
endif()
execute_process(COMMAND ${NODE} bundle.mjs page.html WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(failed)
  message(FATAL_ERROR "${said}")  # a mistake in the page's own sources
endif()
write_shell("")
