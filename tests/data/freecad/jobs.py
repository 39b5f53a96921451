"""Makes jobs in FreeCAD without a screen, and posts them by Trunnion's post: run by ``freecadcmd``.

The environment says where the post is (TRUNNION_POST), where results go (TRUNNION_OUT), with which arguments
(TRUNNION_ARGS, one after the other), and which jobs are made (TRUNNION_JOBS).
"""

# mypy: ignore-errors

import json
import os
import sys
import traceback

import FreeCAD
import MeshPart
import Part
import PathScripts.PathJob as PathJob
import PathScripts.PathPost as PathPost
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController

sys.path.insert(0, os.environ["TRUNNION_POST"])
OUT = os.environ["TRUNNION_OUT"]
V = FreeCAD.Vector


def block():
    """A block of 80 x 60 x 20 with a pocket, a round boss hole and four drilled holes; its top is Z0."""
    body = Part.makeBox(80, 60, 20, V(0, 0, -20))
    body = body.cut(Part.makeBox(24, 20, 8, V(10, 20, -8)))
    body = body.cut(Part.makeCylinder(8, 20, V(58, 30, -20)))
    for x, y in ((6, 6), (74, 6), (74, 54), (6, 54)):
        body = body.cut(Part.makeCylinder(2.5, 20, V(x, y, -20)))
    return body


def face(obj, test):
    """The name of the first face of a part that fits."""
    return next("Face%d" % k for k, each in enumerate(obj.Shape.Faces, 1) if test(each))


def tool(job, number, shape, **sizes):
    """A tool controller of a job with a bit of its own."""
    bit = PathToolBit.Factory.Create("T%d" % number, PathToolBit.findToolShape(shape))
    for name, value in sizes.items():
        setattr(bit, name, value)
    controller = PathToolController.Create("T%d %s" % (number, shape), bit, number)
    controller.SpindleSpeed = 6000
    controller.HorizFeed, controller.VertFeed = "600 mm/min", "200 mm/min"
    job.Proxy.addToolController(controller)
    return controller


def add(job, module, name, controller, bases, **sizes):
    """An operation of a job."""
    operation = __import__("PathScripts." + module, fromlist=["Create"]).Create(name)
    operation.Base = bases
    operation.ToolController = controller
    for key, value in sizes.items():
        operation.setExpression(key, None)
        setattr(operation, key, value)
    operation.Proxy.execute(operation)
    return operation


def jobs(document):
    """Name -> a job, made when it is asked for."""
    part = document.addObject("Part::Feature", "Block")
    part.Shape = block()
    document.recompute()
    floor = face(part, lambda f: abs(f.BoundBox.ZMax + 8) < 1e-6 and abs(f.BoundBox.ZMin + 8) < 1e-6)
    top = face(part, lambda f: abs(f.BoundBox.ZMin) < 1e-6)
    bottom = face(part, lambda f: abs(f.BoundBox.ZMax + 20) < 1e-6)
    bore = face(part, lambda f: "Cylinder" in str(type(f.Surface)) and abs(f.Surface.Radius - 8) < 1e-6)
    holes = [
        "Face%d" % k for k, f in enumerate(part.Shape.Faces, 1)
        if "Cylinder" in str(type(f.Surface)) and abs(f.Surface.Radius - 2.5) < 1e-6
    ]  # fmt: skip

    def made(fill):
        job = PathJob.Create("Job", [part], None)
        model = job.Model.Group[0]
        for old in list(job.Tools.Group):
            job.Tools.removeObject(old)
        fill(job, model)
        document.recompute()
        return job

    def profile(job, model):
        add(job, "PathProfile", "PROFILE", tool(job, 1, "endmill.fcstd", Diameter=10), [(model, [bottom])])

    def pocket(job, model):
        add(
            job, "PathPocketShape", "POCKET", tool(job, 1, "endmill.fcstd", Diameter=6), [(model, [floor])], StepOver=50
        )

    def adaptive(job, model):
        add(job, "PathAdaptive", "ADAPTIVE", tool(job, 2, "endmill.fcstd", Diameter=6), [(model, [floor])])

    def helix(job, model):
        add(job, "PathHelix", "HELIX", tool(job, 1, "endmill.fcstd", Diameter=8), [(model, [bore])])

    def drilling(job, model):
        add(job, "PathDrilling", "DRILL", tool(job, 3, "drill.fcstd", Diameter=5), [(model, holes)], PeckEnabled=True,
            PeckDepth=4)  # fmt: skip

    def facing(job, model):
        add(job, "PathMillFace", "FACE", tool(job, 1, "endmill.fcstd", Diameter=12), [(model, [top])])

    def tags(job, model):
        import PathScripts.PathDressupHoldingTags as PathDressupHoldingTags

        profile(job, model)
        base = job.Operations.Group[0]
        dressup = PathDressupHoldingTags.Create(base, "TAGS")
        job.Operations.removeObject(base)  # as FreeCAD's own command does
        dressup.Proxy.setup(dressup, True)
        dressup.Proxy.execute(dressup)

    def thread(job, model):
        helix(job, model)
        add(job, "PathThreadMilling", "THREAD", tool(job, 5, "thread-mill.fcstd", Diameter=6), [(model, [bore])],
            MajorDiameter=17.5, MinorDiameter=16, Pitch=1.5, Passes=2, LeadInOut=True)  # fmt: skip

    def two_tools(job, model):
        facing(job, model)
        drilling(job, model)

    def two_fixtures(job, model):
        job.Fixtures = ["G54", "G55"]
        pocket(job, model)

    return {
        each.__name__: (lambda each=each: made(each))
        for each in (profile, pocket, adaptive, helix, drilling, facing, tags, thread, two_tools, two_fixtures)
    }


def main():
    """Post each job that is asked for; say what became of it."""
    found = {}
    MeshPart.meshFromShape(Shape=block(), LinearDeflection=0.01, AngularDeflection=0.1).write(
        os.path.join(OUT, "block.stl")
    )
    arguments = os.environ["TRUNNION_ARGS"].split("|")
    for number, name in enumerate(os.environ["TRUNNION_JOBS"].split(",")):
        document = FreeCAD.newDocument(name)
        try:
            job = jobs(document)[name]()
            post = PathPost.CommandPathPost()
            objects = [each for part in post.buildPostList(job) for each in part]
            import trunnion_post

            trunnion_post.export(objects, os.path.join(OUT, name + ".nc"), arguments[number % len(arguments)])
            found[name] = "ok"
        except Exception:
            found[name] = traceback.format_exc()
        FreeCAD.closeDocument(document.Name)
    with open(os.path.join(OUT, "found.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


main()
os._exit(0)
