"""What pf_preprocess.py writes, and how it refuses what pFUnit would not take."""

import sys
import tempfile
import unittest
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import pf_preprocess

SUITE = """! A comment with @test in it.
module test_x
   use funit
   implicit none
contains
{annotation}
{procedure}
{body}
   end subroutine
end module test_x
"""
BODY_LINE = 8


def suite(body="", annotation="@test", procedure="subroutine a_test()"):
    """A .pf file whose line BODY_LINE is the body."""
    return SUITE.format(body=body, annotation=annotation, procedure=procedure)


class Translation(unittest.TestCase):
    """Run the program on a file named test_x.pf."""

    def translate(self, text):
        """Its status, the module, the driver and the error text."""
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder, name) for name in ("test_x.pf", "test_x.f90", "test_x_driver.f90")]
            files[0].write_text(text, encoding="utf-8")
            with redirect_stderr(StringIO()) as errors:
                status = pf_preprocess.main([str(files[0]), "--module", str(files[1]), "--driver", str(files[2])])
            written = [file.read_text(encoding="utf-8") if file.exists() else None for file in files[1:]]
        return status, *written, errors.getvalue()

    def assert_refused(self, text, line, reason):
        """The file is refused for the reason, at the line, and nothing is written."""
        status, module, driver, errors = self.translate(text)
        self.assertEqual(status, 1)
        self.assertIsNone(module)
        self.assertIsNone(driver)
        self.assertRegex(errors, rf"test_x\.pf:{line}: error: .*{reason}")

    def assert_body_refused(self, body, reason):
        self.assert_refused(suite(body), BODY_LINE, reason)


class Output(Translation):
    def test_assertion_names_its_file_and_line(self):
        _, module, _, errors = self.translate(suite("  @assertEqual(f(1, [2]), ', !&@)', message='x')"))
        self.assertEqual(errors, "")
        self.assertIn(
            "  call assertEqual(f(1, [2]), ', !&@)', message='x', &\n"
            f"     & location=SourceLocation('test_x.pf', {BODY_LINE}))\n"
            "  if (anyExceptions()) return\n",
            module,
        )

    def test_assertion_without_argument(self):
        _, module, _, _ = self.translate(suite("@assertExceptionRaised()"))
        self.assertIn("call assertExceptionRaised(&\n   & location=", module)

    def test_longest_directive_fits_free_form(self):
        body = "   @assertTrue(" + "x" * 104 + ")"
        self.assertEqual(len(body), 120)
        _, module, _, errors = self.translate(suite(body))
        self.assertEqual(errors, "")
        self.assertLessEqual(max(map(len, module.splitlines())), 132)

    def test_ordinary_lines_stay(self):
        body = "   x = 'a ! b &\n      & @assertTrue(c)'  ! @assertFalse(d)\n   ! @test"
        _, module, _, errors = self.translate(suite(body))
        self.assertEqual(errors, "")
        self.assertIn(body, module)

    def test_driver_runs_fixtures_and_skips_disabled(self):
        text = suite(annotation="@before", procedure="subroutine up()").replace(
            "end module",
            "@after\n! why\nsubroutine down()\nend subroutine\n@TEST\n@Disable\nSubroutine off( )\nend subroutine\n"
            "@test\nsubroutine on() ! a comment\nend subroutine\nend module",
        )
        _, _, driver, errors = self.translate(text)
        self.assertEqual(errors, "")
        calls = [line.strip() for line in driver.splitlines() if "call " in line]
        self.assertEqual(
            calls,
            [
                "call standin_start('test_x')",
                "call standin_disable('off')",
                "call standin_enter('on')",
                "call up()",
                "call on()",
                "call down()",
                "call standin_leave()",
                "call standin_finish()",
            ],
        )


class Directives(Translation):
    def test_continuation(self):
        self.assert_body_refused("@assertEqual(1, &\n   & 1)", "may not continue with &")

    def test_continuation_in_string(self):
        self.assert_body_refused("@assertFail('one &\n   &two')", "may not continue with &")

    def test_open_parenthesis(self):
        self.assert_body_refused("@assertEqual(1, (2)", "unbalanced parentheses")

    def test_open_string(self):
        self.assert_body_refused("@assertEqual('a, 'a')", "a string in a directive is not closed")

    def test_trailing_comment(self):
        self.assert_body_refused("@assertTrue(.true.) ! sure", "no trailing comment")

    def test_trailing_code(self):
        self.assert_body_refused("@assertTrue(.true.); x = 1", "nothing may follow the closing parenthesis")
        self.assert_body_refused("@assertTrue(.true.) 'x'", "nothing may follow the closing parenthesis")

    def test_one_line_if(self):
        self.assert_body_refused("if (a) @assertTrue(b)", "must be the first on its line, alone")

    def test_long_line(self):
        self.assert_body_refused("@assertTrue(" + "x" * 108 + ")", "at most 120 characters, here are 121")

    def test_unknown(self):
        self.assert_body_refused("@assertSomething(a)", "unknown directive @assertSomething")
        self.assert_refused(suite(annotation="@testCase"), 6, "unknown directive @testCase")

    def test_no_parentheses(self):
        self.assert_body_refused("@assertExceptionRaised", "needs its arguments in parentheses")

    def test_number_of_arguments(self):
        self.assert_body_refused("@assertEqual((1, 2))", r"takes at least 2 argument\(s\), here are 1")
        self.assert_body_refused("@assertTrue()", r"takes at least 1 argument\(s\), here are 0")
        self.assert_body_refused("@assertRelativelyEqual(a, b)", r"takes at least 3 argument\(s\), here are 2")
        self.assert_body_refused("@assertExceptionRaised('why')", "takes no argument")

    def test_preprocessor_line(self):
        self.assert_body_refused("#ifdef X", "a preprocessor line")


class Annotations(Translation):
    def test_disable_without_test(self):
        reason = "only between @test and its subroutine"
        self.assert_refused(suite(annotation="@disable"), 6, reason)
        self.assert_refused(suite(annotation="@before\n@disable"), 7, reason)
        self.assert_refused(suite(annotation="@disable\n@test"), 6, reason)

    def test_recursive_subroutine(self):
        self.assert_refused(suite(procedure="recursive subroutine a()"), 7, "must come .*, not a recursive one")

    def test_subroutine_with_arguments(self):
        self.assert_refused(suite(procedure="subroutine a(i)"), 7, "must come .*, without arguments")

    def test_something_else(self):
        self.assert_refused(suite(procedure="integer function a()"), 7, "must come `subroutine name")

    def test_two_annotations(self):
        self.assert_refused(suite(annotation="@test\n@test"), 7, "the @test of line 6 has no subroutine yet")

    def test_second_fixture(self):
        text = suite(annotation="@before\nsubroutine up()\nend subroutine\n@before")
        self.assert_refused(text, 9, "a second @before")

    def test_options(self):
        self.assert_refused(suite(annotation="@test(npes=[1])"), 6, "@test takes nothing after it")

    def test_end_of_file(self):
        self.assert_refused("module test_x\n@test\n", 2, "@test has no subroutine after it")


class Module(Translation):
    def test_other_name(self):
        self.assert_refused("module test_y\nend module test_y\n", 1, "must be `module test_x`")

    def test_not_first(self):
        self.assert_refused("program p\nend program\n", 1, "the first statement must be")

    def test_something_after_it(self):
        self.assert_refused("module test_x ! the tests\n", 1, "nothing may follow `module test_x`")

    def test_missing(self):
        self.assert_refused("", 1, "no `module test_x` in the file")

    def test_second(self):
        self.assert_refused("module test_x\nend module\nmodule test_x\n", 3, "a second module")

    def test_module_procedure_is_no_module(self):
        _, _, _, errors = self.translate("module Test_X\nmodule procedure f\nend module\n")
        self.assertEqual(errors, "")


if __name__ == "__main__":
    unittest.main()
