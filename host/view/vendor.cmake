# Copies what the page needs out of node_modules: -D modules=DIR -D out=DIR. The add-on of three.js names it by a bare
# word that only a bundler understands; it gets the file's name instead.
file(READ ${modules}/three/examples/jsm/controls/OrbitControls.js text)
string(REPLACE "from 'three';" "from './three.module.js';" text "${text}")
file(WRITE ${out}/OrbitControls.js "${text}")
file(COPY ${modules}/three/build/three.module.js ${modules}/three/build/three.core.js
          ${modules}/uplot/dist/uPlot.esm.js ${modules}/uplot/dist/uPlot.min.css DESTINATION ${out})
file(TOUCH ${out}/three.module.js ${out}/three.core.js ${out}/uPlot.esm.js ${out}/uPlot.min.css)
