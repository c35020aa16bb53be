# Copies the files that the page needs out of node_modules: -D modules=DIR -D out=DIR. The add-ons of three.js import it
# by a bare name, which only bundlers resolve, and each other by folders that the page does not have. These imports are
# replaced by file names.
foreach(addon controls/OrbitControls effects/AnaglyphEffect postprocessing/Pass utils/CameraUtils)
  file(READ ${modules}/three/examples/jsm/${addon}.js text)
  string(REPLACE "from 'three';" "from './three.module.js';" text "${text}")
  string(REGEX REPLACE "from '\\.\\./[a-z]+/([A-Za-z]+\\.js)'" "from './\\1'" text "${text}")
  get_filename_component(name ${addon} NAME)
  file(WRITE ${out}/${name}.js "${text}")
endforeach()
file(COPY ${modules}/three/build/three.module.js ${modules}/three/build/three.core.js
          ${modules}/uplot/dist/uPlot.esm.js ${modules}/uplot/dist/uPlot.min.css DESTINATION ${out})
file(TOUCH ${out}/three.module.js ${out}/three.core.js ${out}/uPlot.esm.js ${out}/uPlot.min.css)
