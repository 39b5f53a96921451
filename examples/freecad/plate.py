"""Makes a plate and its job in FreeCAD without a screen, and posts it: run by ``freecadcmd`` (``make.py freecad``).

The environment says where everything goes (TRUNNION_OUT); ``trunnion freecad install`` has put the post there.
"""

# mypy: ignore-errors

import os
import sys
import traceback

import FreeCAD
import Mesh
import MeshPart
import Part
import PathScripts.PathJob as PathJob
import PathScripts.PathPost as PathPost
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController

OUT = os.environ["TRUNNION_OUT"]
ARGUMENTS = os.environ["TRUNNION_ARGS"]
V = FreeCAD.Vector


def plate():
    """Return a plate of 80 x 60 x 20 with a rounded pocket, a bore and four holes; its top is Z0."""
    body = Part.makeBox(80, 60, 20, V(0, 0, -20))
    pocket = Part.makeBox(28, 24, 8, V(10, 18, -8))
    pocket = pocket.makeFillet(5, [e for e in pocket.Edges if abs(e.BoundBox.ZLength - 8) < 1e-6])
    body = body.cut(pocket).cut(Part.makeCylinder(8, 20, V(58, 30, -20)))
    for x, y in ((6, 6), (74, 6), (74, 54), (6, 54)):
        body = body.cut(Part.makeCylinder(2.5, 20, V(x, y, -20)))
    return body


def faces(shape, test):
    """Return the names of the faces that fit."""
    return ["Face%d" % k for k, each in enumerate(shape.Faces, 1) if test(each)]


def is_level(face, z):
    """Whether a face is plane and lies at a height."""
    return "Plane" in str(face.Surface) and abs(face.BoundBox.ZMax - z) + abs(face.BoundBox.ZMin - z) < 1e-6


def is_round(face, radius):
    """Whether a face is a whole cylinder of a radius."""
    return "Cylinder" in str(face.Surface) and abs(face.Surface.Radius - radius) < 1e-6


def tool(job, number, shape, **sizes):
    """Return a tool controller with a bit of its own."""
    bit = PathToolBit.Factory.Create("T%d" % number, PathToolBit.findToolShape(shape))
    for name, value in sizes.items():
        setattr(bit, name, value)
    controller = PathToolController.Create("T%d" % number, bit, number)
    controller.SpindleSpeed, controller.HorizFeed, controller.VertFeed = 6000, "600 mm/min", "200 mm/min"
    job.Proxy.addToolController(controller)
    return controller


def add(module, name, controller, bases, **sizes):
    """Add an operation of the job."""
    operation = __import__("PathScripts." + module, fromlist=["Create"]).Create(name)
    operation.Base, operation.ToolController = bases, controller
    for key, value in sizes.items():
        operation.setExpression(key, None)
        setattr(operation, key, value)
    operation.Proxy.execute(operation)


def make_job(document):
    """Return the job: faced, pocketed, bored, cut out, drilled."""
    part = document.addObject("Part::Feature", "Plate")
    part.Shape = plate()
    document.recompute()
    job = PathJob.Create("Job", [part], None)
    job.Stock.ExtZneg = 0
    for old in list(job.Tools.Group):
        job.Tools.removeObject(old)
    model, shape = job.Model.Group[0], part.Shape
    mill = tool(job, 1, "endmill.fcstd", Diameter=8, Length=70, CuttingEdgeHeight=30)

    def of(test):
        return [(model, faces(shape, test))]

    add("PathMillFace", "FACE", mill, of(lambda f: is_level(f, 0)), BoundaryShape="Stock", OffsetPattern="Offset")
    add("PathPocketShape", "POCKET", mill, of(lambda f: is_level(f, -8)), StepOver=40, OffsetPattern="Offset")
    add("PathHelix", "BORE", mill, of(lambda f: is_round(f, 8)))
    add("PathProfile", "OUTLINE", mill, of(lambda f: is_level(f, -20)))
    drill = tool(job, 2, "drill.fcstd", Diameter=5, Length=70)
    add(
        "PathDrilling", "HOLES", drill, of(lambda f: is_round(f, 2.5)),
        PeckEnabled=True, PeckDepth=4, ExtraOffset="Drill Tip",
    )  # fmt: skip
    document.recompute()
    return job


def main():
    """Write the part, then post the job as FreeCAD does."""
    sys.path.insert(0, OUT)
    import trunnion_post

    document = FreeCAD.newDocument("Plate")
    job = make_job(document)
    mesh = MeshPart.meshFromShape(Shape=job.Model.Group[0].Shape, LinearDeflection=0.01, AngularDeflection=0.1)
    Mesh.Mesh(mesh).write(os.path.join(OUT, "plate.stl"))
    objects = [each for part in PathPost.CommandPathPost().buildPostList(job) for each in part]
    trunnion_post.export(objects, os.path.join(OUT, "plate.nc"), ARGUMENTS)


try:
    main()
except BaseException:
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(1)
sys.stdout.flush()
os._exit(0)
