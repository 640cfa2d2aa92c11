/*  What is known by name without any run: fluents, events, evidence, and the built-in ontology.

    Made by tools/vocabulary.py from what is declared in Python and in the ontology; not to be edited.
*/

:- module(vocabulary,
          [ fact_type/3,                % ?Name, ?Arity, ?Kind
            evidence_unit/2,            % ?Name, ?Unit
            class/1,                    % ?Class
            parent/2,                   % ?Class, ?Parent
            defined_by/3,               % ?Class, ?Property, ?Filler
            property_parent/2,          % ?Property, ?Parent
            property_inverse/2,         % ?Property, ?Inverse
            property/2,                 % ?Property, ?Unit
            allowed_value/2             % ?Name, ?Value
          ]).

%   fact_type(Name, Arity, Kind): fluents, asserted relations among them, and events.

fact_type(absorbing, 2, event).
fact_type(absorbs, 2, fluent).
fact_type(attached, 2, fluent).
fact_type(batch, 2, fluent).
fact_type(breaking, 1, event).
fact_type(bringing, 2, event).
fact_type(bringing, 3, event).
fact_type(broken, 1, fluent).
fact_type(buckled, 1, fluent).
fact_type(carrying, 2, event).
fact_type(carrying, 3, event).
fact_type(carrying, 4, event).
fact_type(closing, 2, event).
fact_type(closingGripper, 1, event).
fact_type(colliding, 2, event).
fact_type(comprises, 2, fluent).
fact_type(contacts, 2, fluent).
fact_type(contains, 2, fluent).
fact_type(cracked, 1, fluent).
fact_type(crushed, 1, fluent).
fact_type(dented, 1, fluent).
fact_type(dirty, 1, fluent).
fact_type(dripping, 2, event).
fact_type(driving, 2, event).
fact_type(driving, 3, event).
fact_type(driving, 4, event).
fact_type(falling, 1, event).
fact_type(floats, 2, fluent).
fact_type(flowingOnto, 2, event).
fact_type(flowingOut, 2, event).
fact_type(grasping, 3, event).
fact_type(grasping, 4, event).
fact_type(grasping, 5, event).
fact_type(hitting, 3, event).
fact_type(hitting, 4, event).
fact_type(hitting, 5, event).
fact_type(holding, 2, event).
fact_type(immersed, 2, fluent).
fact_type(inFlight, 1, event).
fact_type(lifting, 2, event).
fact_type(lifting, 3, event).
fact_type(lifting, 4, event).
fact_type(lookingAt, 2, event).
fact_type(moving, 1, event).
fact_type(on, 2, fluent).
fact_type(open, 1, fluent).
fact_type(openingGripper, 1, event).
fact_type(overloading, 2, event).
fact_type(peeling, 4, event).
fact_type(peeling, 5, event).
fact_type(pouring, 3, event).
fact_type(pouring, 4, event).
fact_type(pouring, 5, event).
fact_type(pouring, 6, event).
fact_type(pouring, 7, event).
fact_type(pouring, 8, event).
fact_type(pressing, 4, event).
fact_type(pressing, 5, event).
fact_type(pressing, 6, event).
fact_type(raisingTorso, 2, event).
fact_type(reaching, 2, event).
fact_type(reaching, 3, event).
fact_type(reaching, 4, event).
fact_type(reaching, 5, event).
fact_type(releasing, 1, event).
fact_type(replaying, 2, event).
fact_type(spilled, 1, fluent).
fact_type(spilling, 1, event).
fact_type(splitting, 4, event).
fact_type(splitting, 5, event).
fact_type(splitting, 6, event).
fact_type(squeezing, 3, event).
fact_type(squeezing, 4, event).
fact_type(supports, 2, fluent).
fact_type(tilting, 2, event).
fact_type(tilting, 3, event).
fact_type(tipping, 1, event).
fact_type(toppling, 1, event).
fact_type(waiting, 1, event).
fact_type(wet, 1, fluent).
fact_type(wetWith, 2, fluent).
fact_type(wiping, 2, event).

%   evidence_unit(Name, Unit): what evidence is called; the unit of a text is ''.

evidence_unit(angle, rad).
evidence_unit(area, m2).
evidence_unit(area_at_end, m2).
evidence_unit(away, m).
evidence_unit(bears, 'N').
evidence_unit(behind, rad).
evidence_unit(between, '').
evidence_unit(bonds, '1').
evidence_unit(by, '').
evidence_unit(command, 'N').
evidence_unit(commanded_force, 'N').
evidence_unit(commanded_speed, 'm/s').
evidence_unit(depth, m).
evidence_unit(distance, m).
evidence_unit(edge, '').
evidence_unit(ends, '').
evidence_unit(equal_parts, '1').
evidence_unit(fill, '1').
evidence_unit(force, 'N').
evidence_unit(fraction, '1').
evidence_unit(fraction_at_end, '1').
evidence_unit(fraction_least, '1').
evidence_unit(fraction_mean, '1').
evidence_unit(height, m).
evidence_unit(impulse, 'N s').
evidence_unit(largest, '1').
evidence_unit(level, 'N').
evidence_unit(margin, '1').
evidence_unit(mass, kg).
evidence_unit(mean_force, 'N').
evidence_unit(opening_after, m).
evidence_unit(opening_before, m).
evidence_unit(outcome, '').
evidence_unit(over_rim, '1').
evidence_unit(pad_force, 'N').
evidence_unit(parts, '1').
evidence_unit(peak_force, 'N').
evidence_unit(peak_pad_force, 'N').
evidence_unit(pieces, '1').
evidence_unit(pieces_off, '1').
evidence_unit(reason, '').
evidence_unit(result, '').
evidence_unit(second, '1').
evidence_unit(share, '1').
evidence_unit(slip, m).
evidence_unit(slip_speed, 'm/s').
evidence_unit(source, '').
evidence_unit(speed, 'm/s').
evidence_unit(spilled_after, '1').
evidence_unit(spilled_before, '1').
evidence_unit(through_holes, '1').
evidence_unit(tilt, rad).
evidence_unit(tilt_before, rad).
evidence_unit(tries, '1').
evidence_unit(volume, m3).

%   class(Class), parent(Class, Parent): the classes, and those above them as told.

class('Absorbent').
class('Ball').
class('Batch').
class('Bead').
class('Beads').
class('Block').
class('Bowl').
class('Breakable').
class('BrokenThing').
class('BucklingBowl').
class('CandyShell').
class('Carpet').
class('ChocolateKernel').
class('ClayBowl').
class('Coconut').
class('CoconutShell').
class('CoconutWater').
class('Coffee').
class('Container').
class('Cup').
class('DentingBowl').
class('DirtyThing').
class('Egg').
class('EggBox').
class('EggContent').
class('EggKernel').
class('EggShell').
class('EggWhite').
class('EggYolk').
class('Enclosure').
class('Event').
class('Floor').
class('FoamPad').
class('ForceLevel').
class('Fragile').
class('Furniture').
class('GlassBowl').
class('Granular').
class('Gripper').
class('Hand').
class('HardBoiledEgg').
class('HardBoiledQuailEgg').
class('Honey').
class('Kernel').
class('Lawn').
class('Liquid').
class('LiquidContainer').
class('MandM').
class('Membraned').
class('Milk').
class('Obstacle').
class('OliveOil').
class('PR2').
class('Padding').
class('PancakeBatter').
class('PaperBowl').
class('PaperTowel').
class('Part').
class('PhysicalObject').
class('Pouring').
class('QuailEgg').
class('QuailEggKernel').
class('QuailEggShell').
class('QuailEggWhite').
class('QuailEggYolk').
class('Robot').
class('ShapeKind').
class('Shell').
class('ShellContent').
class('Shelled').
class('SlipperyGripper').
class('Solid').
class('Sponge').
class('Stuff').
class('Table').
class('Towel').
class('Vessel').
class('Wall').
class('Water').
class('WetGripper').
class('WetThing').
class('YieldingBowl').

parent('Absorbent', 'Solid').
parent('Ball', 'Solid').
parent('Bead', 'Ball').
parent('Beads', 'Granular').
parent('Block', 'Solid').
parent('Bowl', 'Vessel').
parent('Breakable', 'PhysicalObject').
parent('BrokenThing', 'PhysicalObject').
parent('BucklingBowl', 'YieldingBowl').
parent('CandyShell', 'Shell').
parent('Carpet', 'Floor').
parent('Carpet', 'Padding').
parent('ChocolateKernel', 'Kernel').
parent('ClayBowl', 'DentingBowl').
parent('Coconut', 'Shelled').
parent('CoconutShell', 'Shell').
parent('CoconutWater', 'Liquid').
parent('CoconutWater', 'ShellContent').
parent('Coffee', 'Liquid').
parent('Container', 'PhysicalObject').
parent('Cup', 'Vessel').
parent('DentingBowl', 'YieldingBowl').
parent('DirtyThing', 'PhysicalObject').
parent('Egg', 'PhysicalObject').
parent('Egg', 'Shelled').
parent('EggBox', 'Padding').
parent('EggContent', 'ShellContent').
parent('EggKernel', 'EggContent').
parent('EggKernel', 'Kernel').
parent('EggShell', 'Shell').
parent('EggWhite', 'EggContent').
parent('EggWhite', 'Liquid').
parent('EggYolk', 'EggContent').
parent('EggYolk', 'Liquid').
parent('EggYolk', 'Membraned').
parent('Enclosure', 'Solid').
parent('Floor', 'Furniture').
parent('FoamPad', 'Padding').
parent('Fragile', 'PhysicalObject').
parent('Furniture', 'Solid').
parent('GlassBowl', 'Bowl').
parent('Granular', 'Stuff').
parent('Gripper', 'Solid').
parent('Hand', 'Gripper').
parent('HardBoiledEgg', 'Egg').
parent('HardBoiledQuailEgg', 'HardBoiledEgg').
parent('Honey', 'Liquid').
parent('Kernel', 'ShellContent').
parent('Kernel', 'Solid').
parent('Lawn', 'Floor').
parent('Lawn', 'Padding').
parent('Liquid', 'Stuff').
parent('LiquidContainer', 'Container').
parent('MandM', 'Shelled').
parent('Membraned', 'Stuff').
parent('Milk', 'Liquid').
parent('Obstacle', 'Furniture').
parent('OliveOil', 'Liquid').
parent('PR2', 'Robot').
parent('Padding', 'Solid').
parent('PancakeBatter', 'Liquid').
parent('PaperBowl', 'BucklingBowl').
parent('PaperTowel', 'Towel').
parent('Pouring', 'Event').
parent('QuailEgg', 'Egg').
parent('QuailEggKernel', 'EggKernel').
parent('QuailEggShell', 'EggShell').
parent('QuailEggWhite', 'EggWhite').
parent('QuailEggYolk', 'EggYolk').
parent('Robot', 'PhysicalObject').
parent('Shell', 'Enclosure').
parent('ShellContent', 'PhysicalObject').
parent('Shelled', 'PhysicalObject').
parent('SlipperyGripper', 'WetGripper').
parent('Solid', 'PhysicalObject').
parent('Sponge', 'Absorbent').
parent('Stuff', 'PhysicalObject').
parent('Table', 'Furniture').
parent('Towel', 'Padding').
parent('Vessel', 'Enclosure').
parent('Wall', 'Furniture').
parent('Water', 'Liquid').
parent('WetGripper', 'Gripper').
parent('WetGripper', 'WetThing').
parent('WetThing', 'PhysicalObject').
parent('YieldingBowl', 'Bowl').

%   defined_by(Class, Property, Filler): what a defined class asks for, all of it, where that is a row each.

defined_by('BrokenThing', broken, 'is true').
defined_by('BrokenThing', 'is a', 'PhysicalObject').
defined_by('DirtyThing', dirty, 'is true').
defined_by('DirtyThing', 'is a', 'PhysicalObject').
defined_by('Gripper', 'is a', 'Hand').
defined_by('Hand', 'is a', 'Gripper').
defined_by('LiquidContainer', comprises, 'Liquid').
defined_by('LiquidContainer', 'is a', 'Container').
defined_by('Part', partOf, 'PhysicalObject').
defined_by('SlipperyGripper', 'is a', 'WetGripper').
defined_by('SlipperyGripper', wetWith, 'EggWhite').
defined_by('WetGripper', 'is a', 'Gripper').
defined_by('WetGripper', 'is a', 'WetThing').
defined_by('WetThing', 'is a', 'PhysicalObject').
defined_by('WetThing', wet, 'is true').

%   property_parent(Property, Parent): the properties, and those above them as told.

property_parent(contains, comprises).
property_parent(hasPart, comprises).

%   property_inverse(Property, Inverse): what says the same from the other end, as told.

property_inverse(partOf, hasPart).
property_inverse(supports, on).

%   property(Property, Unit): what individuals have; the unit of what is no quantity is ''.

property(absorbentCapacity, '1').
property(absorbs, '').
property(adhesionStrength, 'Pa').
property(batch, '').
property(bendingStrength, 'Pa').
property(bottomHoleRadius, m).
property(breadth, m).
property(breakingForce, 'N').
property(breakingTime, s).
property(briefForceRatio, '1').
property(broken, '').
property(bucklingDisplacement, m).
property(bucklingForce, 'N').
property(capacity, m3).
property(colour, '').
property(comprises, '').
property(contactAngle, rad).
property(contains, '').
property(crackGrowthExponent, '1').
property(crackReliefShare, '1').
property(crackTipWeakening, '1').
property(crackedForceShare, '1').
property(cushionedBreakingForce, 'N').
property(densificationStrain, '1').
property(density, 'kg/m3').
property(depth, m).
property(dirty, '').
property(drippingRetention, '1').
property(drippingTime, s).
property(edgeRadius, m).
property(file, '').
property(fill, '1').
property(filmThickness, m).
property(force, 'N').
property(fractureEnergy, 'N/m').
property(fractureStrain, '1').
property(friction, '1').
property(frictionWhenWet, '1').
property(grainCount, '1').
property(hasPart, '').
property(height, m).
property(holeAngle, rad).
property(holeCount, '1').
property(holeHeight, m).
property(holeRadius, m).
property(length, m).
property(lid, '').
property(mass, kg).
property(membraneForce, 'N').
property(on, '').
property(opening, m).
property(paddingThickness, m).
property(panelCount, '1').
property(partOf, '').
property(pieceCount, '1').
property(pitch, rad).
property(plateStiffness, 'N/m').
property(poissonRatio, '1').
property(poleStiffnessRatio, '1').
property(poreSize, m).
property(pressingTime, s).
property(probeRadius, m).
property(radius, m).
property(recedingAngle, rad).
property(recoveryTime, s).
property(relativeMolecularMass, '1').
property(restitution, '1').
property(restitutionExponent, '1').
property(restitutionSpeed, 'm/s').
property(roll, rad).
property(saturation, '1').
property(scale, '1').
property(shape, '').
property(shellMembraneStrength, 'N/m').
property(shellMembraneStretch, m).
property(shellThickness, m).
property(squeezedCapacity, '1').
property(supports, '').
property(surfaceStiffness, 'N/m').
property(surfaceTension, 'N/m').
property(temperature, 'K').
property(thickness, m).
property(uptakeSpeed, 'm/s').
property(viscosity, 'Pa s').
property(volume, m3).
property(wet, '').
property(wetWith, '').
property(width, m).
property(x, m).
property(y, m).
property(yaw, rad).
property(yieldStress, 'Pa').
property(youngsModulus, 'Pa').
property(z, m).

%   allowed_value(Name, Value): the values of a property or of evidence, where there are few.

allowed_value(broken, false).
allowed_value(broken, true).
allowed_value(dirty, false).
allowed_value(dirty, true).
allowed_value(lid, false).
allowed_value(lid, true).
allowed_value(outcome, crushed).
allowed_value(outcome, done).
allowed_value(outcome, dropped).
allowed_value(outcome, in_collision).
allowed_value(outcome, missed).
allowed_value(outcome, not_graspable).
allowed_value(outcome, not_held).
allowed_value(outcome, not_reached).
allowed_value(outcome, timed_out).
allowed_value(outcome, unfinished).
allowed_value(outcome, unreachable).
allowed_value(shape, articulated).
allowed_value(shape, bowl).
allowed_value(shape, box).
allowed_value(shape, cup).
allowed_value(shape, cylinder).
allowed_value(shape, ellipsoid).
allowed_value(shape, mesh).
allowed_value(shape, openBox).
allowed_value(shape, parallelGripper).
allowed_value(shape, plane).
allowed_value(shape, sphere).
allowed_value(wet, false).
allowed_value(wet, true).
