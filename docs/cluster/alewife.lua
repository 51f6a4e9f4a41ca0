-- For Lmod: as modulefiles/alewife/0.1.0.lua beside software/alewife/0.1.0/bin/alewife
local version = myModuleVersion()
local root = myFileName():match("^(.*)/modulefiles/")
local base = pathJoin(root, "software", "alewife", version)

whatis("Name: alewife")
whatis("Version: " .. version)
whatis("Description: swimmers in viscous fluid, by finite elements on moving meshes")
help([[alewife list     shows what comes with it
alewife run      runs a case; a run that was stopped or killed continues when it is run again
alewife status   tells how far runs are]])

family("alewife")
prepend_path("PATH", pathJoin(base, "bin"))
