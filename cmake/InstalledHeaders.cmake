# Run while installing: writes the headers of the exported libraries from SOURCE to OUTPUT, where
# `#include "infer/depth/depth_engine.hpp"` has become `#include "alight/infer/depth_engine.hpp"`, so that the installed ones
# need one include folder, which holds nothing but alight/.
set(folders foundation pictures geometry sensors dataset models infer)
list(JOIN folders "|" any_folder)
file(REMOVE_RECURSE ${OUTPUT})
foreach(folder IN LISTS folders)
  file(GLOB_RECURSE headers RELATIVE ${SOURCE} ${SOURCE}/${folder}/*.hpp)
  list(FILTER headers EXCLUDE REGEX "^dataset/[a-z_]+\\.hpp$")  # of the tool alone
  foreach(header IN LISTS headers)
    file(READ ${SOURCE}/${header} text)
    string(REGEX REPLACE "#include \"((${any_folder})/)" "#include \"alight/\\1" text "${text}")
    file(WRITE ${OUTPUT}/${header} "${text}")
  endforeach()
endforeach()
